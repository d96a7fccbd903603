#include "flight/segment/altitude_record.h"

#include "base/error.h"
#include "flight/segment.h"
#include "helpers/flown_points.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::columns_of;
using test::sortie;
using testing::AllOf;
using testing::HasSubstr;

/// The phases of a plain flight whose altitude something is done to.
template <typename Change>
FlightPhases phases_with(Change&& change) {
    auto columns = columns_of(sortie(100, 50.0));
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) change(columns.time_s[i], columns.altitude_m[i]);
    return segment(select_tracks(test::series_of(columns)));
}

void expect_as_flown(const FlightPhases& phases) {
    const auto plain = segment(select_tracks(test::series_of(columns_of(sortie(100, 50.0)))));
    ASSERT_EQ(phases.sorties.size(), 1u);
    ASSERT_EQ(phases.sorties[0].phases.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(phases.sorties[0].phases[i].start.time_s, plain.sorties[0].phases[i].start.time_s, 0.6);
        EXPECT_NEAR(phases.sorties[0].phases[i].end.time_s, plain.sorties[0].phases[i].end.time_s, 0.6);
    }
}

TEST(AltitudeRecord, LeavesOutAndCountsWhatNoAltitudeIs) {
    // What no aircraft at all reaches is no sample of the track any more: see PhysicalBounds.
    for (const double absurd : {1e308, -1e308, 1e9, -116249.0}) {
        expect_as_flown(phases_with([&](double t, double& altitude_m) {
            if (t > 200 && t < 210) altitude_m = absurd;
        }));
    }
    for (const double absurd : {25e3, -900.0}) {
        const auto phases = phases_with([&](double t, double& altitude_m) {
            if (t > 200 && t < 210) altitude_m = absurd;
        });
        expect_as_flown(phases);
    }
}

TEST(AltitudeRecord, LeavesOutAnEstimatorThatLosesItsFixForAWhile) {
    const auto phases = phases_with([](double t, double& altitude_m) {
        if (t > 200 && t < 220) altitude_m = 0.0;
    });
    expect_as_flown(phases);
    ASSERT_EQ(phases.warnings.size(), 1u);
    EXPECT_THAT(phases.warnings[0], HasSubstr("altitudes are removed, between jumps away and back, first at 2"));
}

TEST(AltitudeRecord, WarnsOfAClimbThatNoAircraftFlies) {
    const auto warnings_of = [](double climb_m_per_s) {
        Track altitude{.name = "altitude_m"};
        for (int i = 0; i < 200; ++i) {
            altitude.time_s.push_back(i / 20.0);
            altitude.value.push_back(std::clamp(i / 20.0 - 4.0, 0.0, 1.0) * climb_m_per_s);
        }
        return clean_altitude(altitude).warnings;
    };
    EXPECT_THAT(warnings_of(65.0), testing::IsEmpty());
    EXPECT_THAT(warnings_of(160.0),
                testing::ElementsAre(HasSubstr("m in 0.15 s at 4.0 s, faster than an aircraft: is the time in s")));
    EXPECT_THAT(warnings_of(-160.0), testing::ElementsAre(HasSubstr("faster than an aircraft")));
}

TEST(AltitudeRecord, LeavesOutAnEstimatorThatStandsStillForLonger) {
    const auto phases = phases_with([](double t, double& altitude_m) {
        if (t > 200 && t < 300) altitude_m = -17.0;
    });
    expect_as_flown(phases);
    EXPECT_EQ(phases.warnings.size(), 1u);
}

TEST(AltitudeRecord, SaysThatAnEdgeLiesInATimeWithoutAltitude) {
    auto series = test::series_of(columns_of(sortie(100, 50.0)));
    for (auto& track : series.tracks) {
        if (track.name != "altitude_m") continue;
        Track kept{.name = track.name, .source = track.source};
        for (std::size_t i = 0; i < track.time_s.size(); ++i) {
            if (track.time_s[i] > 80 && track.time_s[i] < 115) continue;
            kept.time_s.push_back(track.time_s[i]);
            kept.value.push_back(track.value[i]);
        }
        track = kept;
    }
    EXPECT_THAT(segment(select_tracks(series)).warnings,
                testing::ElementsAre(HasSubstr("s is uncertain: 36 s without an altitude")));
}

TEST(AltitudeRecord, GivesEachSideOfAJumpAGroundOfItsOwn) {
    const auto phases = phases_with([](double t, double& altitude_m) {
        if (t < 75) altitude_m = -17.0;  // no fix yet
        if (t >= 75) altitude_m += 700.0;
    });
    expect_as_flown(phases);
    ASSERT_EQ(phases.warnings.size(), 1u);
    EXPECT_THAT(phases.warnings[0], HasSubstr("the altitude jumps by +767 m at 75."));
}

TEST(AltitudeRecord, RefusesAnotherUnitThanMetres) {
    const auto phases = phases_with([&](double, double& altitude_m) { altitude_m *= 100.0; });
    EXPECT_TRUE(phases.sorties.empty());
    ASSERT_EQ(phases.ground_events.size(), 1u);
    EXPECT_THAT(phases.ground_events[0].what, HasSubstr("its unit is not m"));
    EXPECT_THROW(phases_with([&](double, double& altitude_m) { altitude_m *= 1000.0; }), InputError);
}

TEST(AltitudeRecord, RefusesAnEstimatorThatRunsAway) {
    EXPECT_THROW(phases_with([](double t, double& altitude_m) { altitude_m = t < 300 ? 1e308 : -1e308; }), InputError);
    EXPECT_THROW(phases_with([](double t, double& altitude_m) { altitude_m = -40.0 * t; }), InputError);
    const auto wanders =
        phases_with([](double t, double& altitude_m) { altitude_m = 1000.0 + 900.0 * std::sin(0.05 * t); });
    EXPECT_TRUE(wanders.sorties.empty());
}

struct Held {
    double altitude_m;
    int samples;
    bool is_stuck = false;  ///< repeats one value; others move by a centimetre from sample to sample
};

/// An altitude, a sample each `step_s`, that holds each level in turn.
Track held(const std::vector<Held>& levels, double step_s = 1.0) {
    Track track{.name = "altitude_m", .source = "GPS.alt"};
    for (const auto& [altitude_m, samples, is_stuck] : levels) {
        for (int k = 0; k < samples; ++k) {
            track.time_s.push_back(step_s * static_cast<double>(track.time_s.size()));
            track.value.push_back(altitude_m + (is_stuck ? 0.0 : 0.01 * k));
        }
    }
    return track;
}

std::size_t jumps_of(const std::vector<Held>& levels, double step_s = 1.0) {
    return clean_altitude(held(levels, step_s)).jumps_s.size();
}

TEST(AltitudeRecord, JumpsByMoreThan10MetresAnd60MetresPerSecond) {
    EXPECT_EQ(jumps_of({{0, 60}, {70, 60}}), 0U);
    EXPECT_EQ(jumps_of({{0, 60}, {71, 60}}), 1U);
    EXPECT_EQ(jumps_of({{0, 60}, {130, 60}}, 2.0), 0U);
    EXPECT_EQ(jumps_of({{0, 60}, {131, 60}}, 2.0), 1U);
}

/// A link that holds 5 s of a descent and delivers them at once is no jump; 100 m after such a pause are one.
TEST(AltitudeRecord, DoesNotJumpWhereALinkDeliversWhatItHeld) {
    const auto jumps_with = [](double at_once_m) {
        Track track;
        for (int i = 0; i < 400; ++i) {
            const double sent_s = 0.5 * i;
            const bool is_held = sent_s > 100.0 && sent_s < 105.0;
            track.time_s.push_back(is_held ? 105.0 + 0.001 * i : std::max(sent_s, sent_s == 105.0 ? 105.3 : 0.0));
            track.value.push_back(sent_s < 104.0 ? 300.0 : 300.0 - at_once_m);
        }
        std::sort(track.time_s.begin(), track.time_s.end());
        return clean_altitude(track).jumps_s.size();
    };
    EXPECT_EQ(jumps_with(34.0), 0U);
    EXPECT_EQ(jumps_with(120.0), 1U);
}

TEST(AltitudeRecord, JumpsWithLessWhereItStoodStillForTenSecondsAndFiveSamples) {
    EXPECT_EQ(jumps_of({{0, 40, true}, {64.5, 60}}), 0U) << "60 m and 5 m/s";
    EXPECT_EQ(jumps_of({{0, 40, true}, {66, 60}}), 1U);
    EXPECT_EQ(jumps_of({{-20, 30}, {0, 10, true}, {66, 60}}), 0U) << "nine seconds";
    EXPECT_EQ(jumps_of({{-20, 30}, {0, 11, true}, {66, 60}}), 1U) << "ten seconds";
    EXPECT_EQ(jumps_of({{-20, 30}, {0, 4, true}, {100, 60}}, 4.0), 0U) << "four samples";
    EXPECT_EQ(jumps_of({{-20, 30}, {0, 5, true}, {100, 60}}, 4.0), 1U) << "five samples";
}

TEST(AltitudeRecord, LeavesOutWhatComesBackWithin30SecondsOr120WhereItStoodStill) {
    EXPECT_EQ(jumps_of({{0, 300}, {500, 29}, {3, 300}}), 0U);
    EXPECT_EQ(jumps_of({{0, 300}, {500, 31}, {3, 300}}), 2U);
    EXPECT_EQ(jumps_of({{0, 300}, {500, 119, true}, {3, 300}}), 0U);
    EXPECT_EQ(jumps_of({{0, 300}, {500, 121, true}, {3, 300}}), 2U);
}

TEST(AltitudeRecord, LeavesOutPiecesOfLessThanFiveSeconds) {
    EXPECT_EQ(jumps_of({{0, 60}, {400, 5}, {800, 60}}), 1U);
    EXPECT_EQ(jumps_of({{0, 60}, {400, 6}, {800, 60}}), 2U);
}

TEST(AltitudeRecord, IsUnusableWithMoreThanTenJumpsOrOneOfAKilometre) {
    const auto stairs = [](int steps) {
        std::vector<Held> levels;
        for (int k = 0; k <= steps; ++k) levels.push_back({100.0 * k, 40});
        return clean_altitude(held(levels)).unusable_reason;
    };
    EXPECT_EQ(stairs(10), "");
    EXPECT_THAT(stairs(11), HasSubstr("runs from 0 to 1100.39 m with 11 jumps"));
    const auto after = [](double jump_m, int samples) {
        return clean_altitude(held({{0, samples}, {jump_m, 60}})).unusable_reason;
    };
    EXPECT_EQ(after(999.0, 60), "");
    EXPECT_THAT(after(1001.0, 60), HasSubstr("with 1 jumps"));
    EXPECT_EQ(after(1001.0, 20), "") << "19 s";
    EXPECT_NE(after(1001.0, 21), "") << "20 s";
}

TEST(AltitudeRecord, KeepsWhatASmallAircraftFlies) {
    // A hotliner: 100 m in 3 s, and down again as fast, from an altitude that does not move to the millimetre.
    std::vector<test::Point> points{{0, 0, 0}, {60, 0, 0}, {61, 0, 100}, {64, 100, 100}, {65, 100, 0}};
    points.insert(points.end(), {{200, 80, 0}, {201, 80, 100}, {204, 180, 100}, {205, 180, 0}, {400, 150, 0}});
    points.insert(points.end(), {{405, 20, 0}, {430, 0, 0}, {500, 0, 0}});
    auto columns = columns_of(points, 0.5);
    columns.ground_speed_m_per_s.assign(columns.time_s.size(), 15.0);
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        if (columns.altitude_m[i] == 0.0) columns.ground_speed_m_per_s[i] = 0.0;
    }
    const auto phases = segment(select_tracks(test::series_of(columns)));
    EXPECT_EQ(phases.sorties.size(), 1u);
    EXPECT_TRUE(phases.warnings.empty());
}

}  // namespace
}  // namespace flightwatt::flight
