#include "path/path_tracker.h"

#include "helpers/made_up_paths.h"
#include "helpers/selected_tracks.h"
#include "path/remaining_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

constexpr double begin_s = 100.0;

std::optional<PathFix> locate(const PathForecast& path, const flight::FlightSeries& series, double start_s,
                              double until_s) {
    return locate_on_path(path, select_tracks(series), start_s, until_s);
}

/// A survey with circles in it, and two legs that are flown in both directions.
FlightPath survey() {
    FlightPath path;
    path.elements = {test::path_element(Leg{900.0, 20.0}),
                     test::path_element(Circles{70.0, 4.0, true, 20.0}),
                     test::path_element(Leg{300.0, 110.0}),
                     test::path_element(Leg{900.0, 200.0}),
                     test::path_element(Circles{60.0, 2.5, false, 200.0}),
                     test::path_element(Leg{500.0, 20.0}),
                     test::path_element(Leg{500.0, 200.0}),
                     test::path_element(Leg{400.0, 290.0})};
    return path;
}

struct Flown {
    flight::FlightSeries series;
    std::vector<double> planned_s;  ///< where on the path it truly is at each position, in planned time
    double end_s = 0.0;
};

struct Conditions {
    Wind planned = {};
    Wind true_wind = {};
    double noise_m = 4.0;
    LocalPosition origin = {};  ///< of the path, from where its first position is
    double detour_at_s = -1.0;  ///< of the flight's time
    double detour_s = 0.0;
    double every_s = 0.25;
};

/// What is planned to be where the flight is after `time_s` in its own wind.
double planned_s(const PathForecast& plan, const PathTrajectory& flown, double time_s) {
    const auto place = position_at(flown, time_s);
    double planned_s = 0.0;
    for (std::size_t i = 0; i < std::min(place.element, plan.flown().element_s.size()); ++i)
        planned_s += plan.flown().element_s[i];
    return place.element < plan.flown().element_s.size()
               ? planned_s + place.part * plan.flown().element_s[place.element]
               : planned_s;
}

Flown fly(const FlightPath& path, const Conditions& conditions, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, conditions.noise_m);
    const PathForecast plan({path, conditions.planned, test::made_up_wing()});
    const auto flown = compute_trajectory(path, conditions.true_wind);
    Flown result;
    flight::Track east{.name = "east_m", .source = "NAVIGATION.pos_x"};
    flight::Track north{.name = "north_m", .source = "NAVIGATION.pos_y"};
    const double all_s = flown.duration_s + conditions.detour_s;
    for (double t = 0.0; t <= all_s; t += conditions.every_s) {
        double on_path_s = t;
        LocalPosition away;
        if (conditions.detour_at_s >= 0.0 && t > conditions.detour_at_s) {
            const double gone_s = std::min(t - conditions.detour_at_s, conditions.detour_s);
            on_path_s = t - gone_s;
            if (gone_s < conditions.detour_s) {
                const double angle = 2.0 * M_PI * gone_s / conditions.detour_s;
                away = {400.0 * std::sin(angle), 400.0 * (1.0 - std::cos(angle))};
            }
        }
        const auto at = local_position_at(path, position_at(flown, on_path_s));
        const bool is_first = t == 0.0;
        for (auto* track : {&east, &north}) track->time_s.push_back(begin_s + t);
        east.value.push_back(700.0 + at.east_m + away.east_m + (is_first ? 0.0 : conditions.origin.east_m) +
                             noise(random));
        north.value.push_back(-90.0 + at.north_m + away.north_m + (is_first ? 0.0 : conditions.origin.north_m) +
                              noise(random));
        result.planned_s.push_back(planned_s(plan, flown, on_path_s));
    }
    result.end_s = begin_s + all_s;
    result.series.tracks = {std::move(east), std::move(north)};
    return result;
}

/// The worst of the places that are reported every 10 s, from 30 s on; -1 where one is not reported.
double worst_s(const FlightPath& path, const Conditions& conditions, const Flown& flown) {
    const PathForecast plan({path, conditions.planned, test::made_up_wing()});
    double worst_s = 0.0;
    for (double time_s = begin_s + 30.0; time_s < flown.end_s - 10.0; time_s += 10.0) {
        const auto located = locate(plan, truncate_series(flown.series, time_s), begin_s, time_s);
        if (!located || !located->path_time_s) return -1.0;
        const auto index = static_cast<std::size_t>((time_s - begin_s) / conditions.every_s);
        const double off_s = std::abs(*located->path_time_s - flown.planned_s[index]);
        if (located->is_on_path) worst_s = std::max(worst_s, off_s);
    }
    return worst_s;
}

TEST(PathTracker, IsFoundInWindsThatMakeTheFlightFasterAndSlowerThanPlanned) {
    const auto path = survey();
    const std::vector<Conditions> all{
        {}, {{}, {6.0, 20.0}}, {{}, {6.0, 200.0}}, {{}, {8.0, 110.0}}, {{6.0, 20.0}, {}}, {{5.0, 200.0}, {7.0, 60.0}}};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto flown = fly(path, all[i], 11 + static_cast<std::uint32_t>(i));
        const double worst = worst_s(path, all[i], flown);
        EXPECT_GE(worst, 0.0) << i;
        EXPECT_LT(worst, 8.0) << i;
    }
}

TEST(PathTracker, BearsNoiseAndAPathThatBeginsElsewhere) {
    const auto path = survey();
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> far(0.0, 40.0);
        Conditions conditions{{}, {4.0, 20.0}, 10.0, {far(random), far(random)}};
        const auto flown = fly(path, conditions, seed);
        const double worst = worst_s(path, conditions, flown);
        EXPECT_GE(worst, 0.0) << seed;
        EXPECT_LT(worst, 12.0) << seed << " " << conditions.origin.east_m << " " << conditions.origin.north_m;
    }
}

TEST(PathTracker, ADetourIsSeenAndThePathGoesOnWhereItWasLeft) {
    const auto path = survey();
    Conditions conditions;
    conditions.detour_at_s = 230.0;
    conditions.detour_s = 120.0;
    const auto flown = fly(path, conditions, 5);
    const PathForecast plan({path, {}, test::made_up_wing()});
    const auto at = [&](double time_s) {
        return locate(plan, truncate_series(flown.series, begin_s + time_s), begin_s, begin_s + time_s);
    };
    ASSERT_TRUE(at(290.0));
    EXPECT_FALSE(at(290.0)->is_on_path);
    EXPECT_NEAR(at(290.0)->path_time_s.value(), 230.0, 26.0) << "where it was left";
    const auto left = local_position_at(path, position_at(plan.flown(), *at(290.0)->path_time_s));
    const auto away = at(290.0)->at.value() - left;
    EXPECT_GT(std::hypot(away.east_m, away.north_m), 300.0);
    ASSERT_TRUE(at(390.0));
    EXPECT_TRUE(at(390.0)->is_on_path);
    EXPECT_NEAR(at(390.0)->path_time_s.value(), 270.0, 8.0);
}

TEST(PathTracker, IsNotToldByPositionsElsewhereOrMissingOnes) {
    const PathForecast plan({survey(), {}, test::made_up_wing()});
    FlightPath other;
    other.elements = {test::path_element(Circles{150.0, 8.0, false, 270.0})};
    const auto elsewhere = fly(other, {}, 3);
    EXPECT_FALSE(locate(plan, elsewhere.series, begin_s, begin_s + 400.0).value().path_time_s);
    EXPECT_FALSE(locate(plan, {}, begin_s, begin_s + 400.0));
    const auto late = fly(survey(), {}, 3);
    EXPECT_FALSE(locate(plan, late.series, begin_s - 30.0, begin_s + 200.0)) << "from where is not known";
}

TEST(PathTracker, NothingLaterIsLookedAt) {
    const auto path = survey();
    const auto flown = fly(path, {}, 8);
    const PathForecast plan({path, {}, test::made_up_wing()});
    const double until_s = begin_s + 222.2;
    const auto whole = locate(plan, flown.series, begin_s, until_s);
    const auto known = locate(plan, truncate_series(flown.series, until_s), begin_s, until_s);
    ASSERT_TRUE(whole && known);
    EXPECT_NEAR(whole->path_time_s.value(), known->path_time_s.value(), 1.0);
}

}  // namespace
}  // namespace flightwatt::path
