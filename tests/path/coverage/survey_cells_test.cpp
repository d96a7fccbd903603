#include "path/coverage/survey_cells.h"

#include "helpers/rejected.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <variant>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

Polygon rectangle(double west_m, double south_m, double east_m, double north_m) {
    return {{west_m, south_m}, {east_m, south_m}, {east_m, north_m}, {west_m, north_m}};
}

FlightPath flown(const SurveyedArea& area, double spacing_m, double course_deg) {
    PathEntry like;
    like.name = "the survey";
    std::vector<PathEntry> entries;
    write_area_survey({like, entries}, area, spacing_m, course_deg, area.areas.front().front());
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 10.0;
    defaults.start = area.areas.front().front();
    return build_path(entries, defaults);
}

bool is_within(const Polygon& polygon, const LocalPosition& place) {
    for (const auto& part : parts_within(polygon, 0.0, place.east_m))
        if (part.from_m < place.north_m && place.north_m < part.to_m) return true;
    return false;
}

/// The places of a path, some 2 m apart, from the origin.
std::vector<LocalPosition> places(const FlightPath& path, const LocalPosition& start) {
    std::vector<LocalPosition> found;
    for (std::size_t i = 0; i < path.elements.size(); ++i) {
        const auto* leg = std::get_if<Leg>(&path.elements[i].shape);
        const int steps = leg != nullptr ? static_cast<int>(leg->length_m / 2.0) + 1 : 40;
        for (int step = 0; step <= steps; ++step) {
            const auto place = local_position_at(path, {i, static_cast<double>(step) / steps});
            found.push_back({start.east_m + place.east_m, start.north_m + place.north_m});
        }
    }
    return found;
}

/// The share of the places of a grid of 5 m in the area, and outside of closed zones widened by half of the spacing,
/// that a line of at most half of the spacing passes.
double covered(const SurveyedArea& area, double spacing_m, double course_deg) {
    const ClosedZones kept_away(area.closed, spacing_m / 2.0);
    const auto cells = survey_cells(area.areas, kept_away, spacing_m, course_deg, {});
    std::size_t all = 0, seen = 0;
    for (double east = -20.0; east < 620.0; east += 5.0) {
        for (double north = -20.0; north < 620.0; north += 5.0) {
            const LocalPosition place{east, north};
            const auto contains = [&](const Polygon& polygon) { return is_within(polygon, place); };
            if (std::ranges::none_of(area.areas, contains) || std::ranges::any_of(area.closed, contains)) continue;
            ++all;
            const auto at = along_and_across(place, course_deg);
            bool is_seen = false;
            for (const auto& cell : cells)
                for (const auto& line : cell) {
                    const auto from = along_and_across(line.from, course_deg);
                    const auto to = along_and_across(line.to, course_deg);
                    is_seen = is_seen || (std::abs(from.across_m - at.across_m) <= spacing_m / 2.0 + 1e-6 &&
                                          from.along_m - spacing_m / 2.0 <= at.along_m &&
                                          at.along_m <= to.along_m + spacing_m / 2.0);
                }
            if (is_seen) ++seen;
        }
    }
    return static_cast<double>(seen) / static_cast<double>(all);
}

TEST(SurveyCells, AreOneForAConvexArea) {
    const auto cells = survey_cells({rectangle(0, 0, 400, 300)}, ClosedZones({}, 0.0), 50.0, 0.0, {});
    ASSERT_EQ(cells.size(), 1U);
    ASSERT_EQ(cells[0].size(), 8U);
    EXPECT_NEAR(cells[0][0].from.east_m, 25.0, 1e-9);
    EXPECT_NEAR(cells[0][0].to.north_m, 300.0, 1e-9);
}

TEST(SurveyCells, DoNotReachAcrossANotch) {
    const Polygon u_shape{{0, 0}, {400, 0}, {400, 300}, {300, 300}, {300, 100}, {100, 100}, {100, 300}, {0, 300}};
    const auto cells = survey_cells({u_shape}, ClosedZones({}, 0.0), 20.0, 90.0, {});
    ASSERT_EQ(cells.size(), 3U);  // the foot, and both arms
    EXPECT_EQ(cells[0].size() + cells[1].size() + cells[2].size(), 5U + 10U + 10U);
}

TEST(SurveyCells, OfAHoleLieBeforeBesideAndBehindIt) {
    const auto hole = rectangle(150, 100, 250, 200);
    const auto cells = survey_cells({rectangle(0, 0, 400, 300)}, ClosedZones({hole}, 10.0), 20.0, 0.0, {});
    EXPECT_EQ(cells.size(), 4U);
}

TEST(AreaSurveys, NeverLeadOverAHole) {
    const SurveyedArea area{{rectangle(0, 0, 400, 300)}, {rectangle(150, 100, 250, 200)}};
    for (const double course_deg : {0.0, 37.0, 90.0, 200.0})
        for (const auto& place : places(flown(area, 20.0, course_deg), {0.0, 0.0}))
            ASSERT_FALSE(is_within(area.closed[0], place))
                << course_deg << ": " << place.east_m << ' ' << place.north_m;
}

TEST(AreaSurveys, CoverWhatIsFlownAndNothingElse) {
    EXPECT_GT(covered({{rectangle(0, 0, 400, 300)}, {rectangle(150, 100, 250, 200)}}, 20.0, 0.0), 0.98);
    EXPECT_GT(covered({{rectangle(0, 0, 200, 300), rectangle(300, 0, 600, 300)}, {}}, 30.0, 40.0), 0.95);
}

TEST(AreaSurveys, OfRandomAreasAvoidRandomZones) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto star = [&](double east_m, double north_m, double radius_m, int corners) {
        Polygon polygon;
        for (int i = 0; i < corners; ++i) {
            const double radius = radius_m * (0.4 + 0.6 * uniform(random));
            polygon.push_back(moved({east_m, north_m}, radius, 360.0 * i / corners));
        }
        return polygon;
    };
    int enclosed = 0;
    for (int trial = 0; trial < 25; ++trial) {
        SurveyedArea area;
        area.areas.push_back(star(300.0, 300.0, 300.0, 5 + trial % 7));
        for (int zone = 0; zone < 1 + trial % 3; ++zone)
            area.closed.push_back(star(150.0 + 300.0 * uniform(random), 150.0 + 300.0 * uniform(random),
                                       20.0 + 60.0 * uniform(random), 3 + trial % 5));
        // The start, at the area's first corner, is outside of the zones.
        const double spacing_m = 15.0 + 25.0 * uniform(random);
        const double course_deg = 360.0 * uniform(random);
        FlightPath path;
        try {
            path = flown(area, spacing_m, course_deg);
        } catch (const InputError&) {  // zones that overlap enclose a piece
            ++enclosed;
            continue;
        }
        for (const auto& place : places(path, area.areas[0][0]))
            for (const auto& zone : area.closed)
                ASSERT_FALSE(is_within(zone, place))
                    << "trial " << trial << " at " << place.east_m << ' ' << place.north_m;
        EXPECT_GT(covered(area, spacing_m, course_deg), 0.85) << "trial " << trial;
    }
    EXPECT_LT(enclosed, 3);
}

TEST(AreaSurveys, AreRefusedWithoutALine) {
    const SurveyedArea closed{{rectangle(0, 0, 100, 100)}, {rectangle(-50, -50, 150, 150)}};
    EXPECT_NE(rejected([&] { flown(closed, 20.0, 0.0); }).find("no lines 20 m apart"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::path
