#include "flight/segment/motor_record.h"

#include "flight/segment.h"
#include "helpers/flown_points.h"
#include "helpers/selected_tracks.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::columns_of;
using test::sortie;
using testing::HasSubstr;

/// A plain flight: 0.4 W on the ground, 30 to 45 W with the motor running; its estimator converged before.
test::SampleColumns measured_flight() {
    std::vector<test::Point> points{{0, 0, 0}, {20, 0, 0}, {35, 50, 0}};
    for (const auto& point : sortie(100, 50.0)) points.push_back(point);
    auto columns = columns_of(points);
    for (auto& power_w : columns.power_w) power_w = 0.4 + 0.5 * power_w;
    return columns;
}

/// A hundred times what the series states.
std::vector<double> columns_of_percent(const FlightSeries& series) {
    std::vector<double> percent;
    for (const auto& track : series.tracks) {
        if (track.name != "throttle_percent") continue;
        for (const double part : track.value) percent.push_back(part * 100.0);
    }
    return percent;
}

void expect_same_phases(const FlightPhases& phases, const FlightPhases& expected) {
    ASSERT_EQ(phases.sorties.size(), expected.sorties.size());
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        const auto& found = phases.sorties[s].phases;
        ASSERT_EQ(found.size(), expected.sorties[s].phases.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i].start.time_s, expected.sorties[s].phases[i].start.time_s, 1.0);
            EXPECT_NEAR(found[i].end.time_s, expected.sorties[s].phases[i].end.time_s, 1.0);
        }
    }
}

TEST(MotorRecord, TakesPowerWhereThereIsNoThrottle) {
    auto columns = measured_flight();
    const auto expected = segment(select_tracks(test::series_of(columns)));
    ASSERT_EQ(expected.sorties.size(), 1u);
    EXPECT_EQ(expected.motor_source, "series CSV");
    columns.throttle_percent.clear();
    const auto phases = segment(select_tracks(test::series_of(columns)));
    expect_same_phases(phases, expected);
    EXPECT_EQ(phases.motor_source, "power: idle 0.4 W, running 45.4 W");
    EXPECT_THAT(phases.warnings, testing::Contains(HasSubstr("no throttle: the motor runs above 4.9 W")));
    EXPECT_THAT(phases.ground_events.at(0).what, HasSubstr("power at its idle"));
}

TEST(MotorRecord, TakesPowerWhereTheThrottleNeverChanges) {
    auto columns = measured_flight();
    const auto expected = segment(select_tracks(test::series_of(columns)));
    for (auto& throttle : columns.throttle_percent) throttle = 0.0;
    expect_same_phases(segment(select_tracks(test::series_of(columns))), expected);
}

TEST(MotorRecord, LeavesOutThrottleThatTheMotorDoesNotFollow) {
    auto columns = measured_flight();
    const auto expected = segment(select_tracks(test::series_of(columns)));
    std::mt19937 random(7);
    for (auto& throttle : columns.throttle_percent) {
        if (random() % 10 == 0) throttle = 100.0;
    }
    const auto phases = segment(select_tracks(test::series_of(columns)));
    expect_same_phases(phases, expected);
    EXPECT_THAT(phases.warnings,
                testing::Contains(HasSubstr("of the throttle are removed: it is open, but the power idle")));
}

TEST(MotorRecord, TakesAThrottleWithoutPowerForAGlitchUpToTenSeconds) {
    const auto opens_for = [](double length_s) {
        auto columns = measured_flight();
        for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
            const double since_s = columns.time_s[i] - columns.time_s.back() + 60.0;
            if (since_s >= 0.0 && since_s < length_s) columns.throttle_percent[i] = 60.0;
        }
        return segment(select_tracks(test::series_of(columns))).warnings;
    };
    const auto glitch = testing::Contains(HasSubstr("of the throttle are removed: it is open, but the power idle"));
    EXPECT_THAT(opens_for(10.0), glitch);
    EXPECT_THAT(opens_for(12.0), Not(glitch));
}

TEST(MotorRecord, SaysThatNothingTellsOfTheMotor) {
    auto columns = measured_flight();
    columns.throttle_percent.clear();
    columns.power_w.assign(columns.time_s.size(), 12.0);
    const auto phases = segment(select_tracks(test::series_of(columns)));
    EXPECT_EQ(phases.motor_source, "nothing");
    EXPECT_THAT(phases.warnings, testing::Contains(HasSubstr("no throttle: segmented by altitude only")));
    for (const auto& event : phases.ground_events) {
        EXPECT_THAT(event.what, testing::Not(HasSubstr("motor off"))) << "no one measured that";
    }
}

TEST(MotorRecord, TakesTheMotorsSpeedWhereNeitherThrottleNorPowerTells) {
    auto columns = measured_flight();
    const auto expected = segment(select_tracks(test::series_of(columns)));
    columns.power_w.assign(columns.time_s.size(), 12.0);
    for (const double full_rpm : {min_running_rpm * 1.01, min_running_rpm * 0.99}) {
        columns.motor_speed_rpm.clear();
        for (const double percent : columns.throttle_percent)
            columns.motor_speed_rpm.push_back(full_rpm * std::min(percent / 60.0, 1.0));
        auto without = columns;
        without.throttle_percent.clear();
        const auto phases = segment(select_tracks(test::series_of(without)));
        const bool turns = full_rpm > min_running_rpm;
        EXPECT_EQ(phases.motor_source, turns ? "series CSV: full 505 rpm" : "nothing");
        EXPECT_THAT(phases.warnings,
                    testing::Contains(HasSubstr(turns ? "the motor runs by its speed" : "segmented by altitude only")));
        if (turns) expect_same_phases(phases, expected);
    }
}

TEST(MotorRecord, TakesAThrottleFromZeroToOneForAFraction) {
    for (const double watts : {1.0, 0.0}) {
        auto columns = measured_flight();
        for (auto& power_w : columns.power_w) power_w *= watts;
        const auto expected = segment(select_tracks(test::series_of(columns)));
        for (auto& throttle : columns.throttle_percent) throttle /= 100.0;
        const auto series = test::series_of(columns);
        expect_same_phases(segment(select_tracks(series)), expected);
        EXPECT_EQ(select_track(series, "throttle_percent").value, columns_of_percent(series));
        EXPECT_THAT(warnings_of(series),
                    testing::Contains(HasSubstr("is 0 to 0.9: it is read as a fraction, 0 to 90 %")));
    }
    // On the ground, with the motor off, it is what it states.
    auto columns = measured_flight();
    for (auto& power_w : columns.power_w) power_w = 0.4;
    for (auto& throttle : columns.throttle_percent) throttle = throttle > 0 ? 1.0 : 0.0;
    EXPECT_THAT(warnings_of(test::series_of(columns)), testing::Not(testing::Contains(HasSubstr("fraction"))));
    EXPECT_TRUE(segment(select_tracks(test::series_of(columns))).sorties.empty());
}

TEST(MotorRecord, BelievesNoThrottleBeyondFull) {
    auto columns = measured_flight();
    const auto expected = segment(select_tracks(test::series_of(columns)));
    for (auto& throttle : columns.throttle_percent) throttle += 213.0;
    const auto phases = segment(select_tracks(test::series_of(columns)));
    expect_same_phases(phases, expected);
    EXPECT_THAT(phases.warnings, testing::Contains(HasSubstr("no throttle: the motor runs above")));
}

/// Two flights, of which the second has a throttle of 0: flown in manual mode.
FlightSeries manual_flight(double speed_m_per_s) {
    auto points = sortie(100);
    for (const auto& point : sortie(700)) points.push_back(point);
    auto columns = columns_of(points);
    columns.ground_speed_m_per_s.assign(columns.time_s.size(), 0.0);
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        if (columns.altitude_m[i] > 1.0) columns.ground_speed_m_per_s[i] = speed_m_per_s;
        if (columns.time_s[i] > 600.0) columns.throttle_percent[i] = 0.0;
    }
    return test::series_of(columns);
}

TEST(MotorRecord, TakesPowerWhereTheThrottleIsThatOfManualMode) {
    const auto phases = segment(select_tracks(manual_flight(12.0)));
    ASSERT_EQ(phases.sorties.size(), 2U);
    EXPECT_NEAR(phases.sorties[1].start_s() - phases.sorties[0].start_s(), 600.0, 2.0);
    EXPECT_NEAR(phases.sorties[1].end_s() - phases.sorties[0].end_s(), 600.0, 2.0);
    EXPECT_THAT(phases.warnings,
                testing::Contains(testing::AllOf(HasSubstr("is idle while the power is that of a running motor ("),
                                                 HasSubstr("the latter is used there"))));
    // What stands, with power for its electronics, keeps its throttle.
    const auto standing = segment(select_tracks(manual_flight(3.9)));
    EXPECT_THAT(standing.warnings, Not(testing::Contains(HasSubstr("the latter is used there"))));
}

TEST(MotorRecord, TakesPowerWhereTheThrottleOfAVtolIsNotThatOfItsLiftMotors) {
    auto columns = columns_of(sortie(100));
    const auto expected = segment(select_tracks(test::series_of(columns)));
    // Less than half a minute of hover before and after the wing; on the ground an idle power.
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        const bool hovers = columns.time_s[i] < 125.0 || columns.time_s[i] > 445.0;
        const bool lifts = hovers && columns.altitude_m[i] > 0.0;
        columns.power_w[i] = lifts ? 900.0 : columns.power_w[i] + 4.0;  // on the wing less than a tenth of that
        if (hovers) columns.throttle_percent[i] = 0.0;
    }
    auto series = test::series_of(columns);
    series.tracks.push_back(
        {.name = "vtol_state", .source = "QTUN.ThO", .time_s = {0.0, 125.0, 445.0}, .value = {3.0, 4.0, 3.0}});
    const auto phases = segment(select_tracks(series));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].start_s(), expected.sorties.at(0).start_s(), 1.5);
    EXPECT_NEAR(phases.sorties[0].end_s(), expected.sorties.at(0).end_s(), 1.5);
    EXPECT_EQ(phases.motor_source, "series CSV and power: idle 4.0 W, running 900.0 W");
}

TEST(MotorRecord, TakesPowerFromHalfAMinuteOn) {
    const auto with_power_for = [](double powered_s) {
        auto columns = columns_of(sortie(100));
        for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
            const double since_s = columns.time_s[i] - 480.0;  // after the landing
            if (since_s >= 0.0 && since_s <= powered_s) columns.power_w[i] = 60.0;
        }
        return segment(select_tracks(test::series_of(columns))).warnings;
    };
    const auto counts = testing::Contains(HasSubstr("the latter is used there"));
    EXPECT_THAT(with_power_for(28.0), Not(counts));
    EXPECT_THAT(with_power_for(33.0), counts);
}

TEST(MotorRecord, TakesTheMotorsSpeedWhereTheThrottleIdlesAndPowerTellsNothing) {
    const auto turning_for = [](double turning_s) {
        auto columns = columns_of(sortie(100));
        columns.power_w.assign(columns.time_s.size(), 12.0);
        for (const double percent : columns.throttle_percent) columns.motor_speed_rpm.push_back(100.0 * percent);
        for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
            const double since_s = columns.time_s[i] - 480.0;  // after the landing
            if (since_s >= 0.0 && since_s <= turning_s) columns.motor_speed_rpm[i] = 3000.0;
        }
        return segment(select_tracks(test::series_of(columns))).warnings;
    };
    const auto counts = testing::Contains(
        testing::AllOf(HasSubstr("is idle while the motor turns at"), HasSubstr("the latter is used there")));
    EXPECT_THAT(turning_for(28.0), Not(counts));
    EXPECT_THAT(turning_for(33.0), counts);
}

struct Section {
    double height_m;
    double power_w;
    int seconds;
    double throttle_percent = 0.0;
};

/// The record of these, one after the other, a sample each second.
MotorRecord record_of(const std::vector<Section>& sections) {
    test::SampleColumns columns;
    for (const auto& [height_m, power_w, seconds, throttle_percent] : sections) {
        for (int i = 0; i < seconds; ++i) {
            columns.time_s.push_back(static_cast<double>(columns.time_s.size()));
            columns.altitude_m.push_back(height_m);
            columns.power_w.push_back(power_w);
            columns.throttle_percent.push_back(throttle_percent);
        }
    }
    const auto series = test::series_of(columns);
    return motor_record(select_tracks(series), select_track(series, "altitude_m"));
}

/// Whether power shows when the motor runs.
bool is_shown(const std::vector<Section>& sections) { return record_of(sections).indicator == MotorIndicator::power; }

TEST(MotorRecord, TakesPowerOfThreeTimesTheIdleOneAndTwoWattsMore) {
    EXPECT_TRUE(is_shown({{0, 2.0, 20}, {100, 6.1, 60}}));
    EXPECT_FALSE(is_shown({{0, 2.0, 20}, {100, 5.9, 60}}));
    EXPECT_TRUE(is_shown({{0, 0.5, 20}, {100, 2.6, 60}}));
    EXPECT_FALSE(is_shown({{0, 0.5, 20}, {100, 2.4, 60}}));
}

TEST(MotorRecord, TakesTwentySamplesOfPowerOfWhichTenAreOnTheGround) {
    EXPECT_TRUE(is_shown({{0, 1, 10}, {100, 30, 10}}));
    EXPECT_FALSE(is_shown({{0, 1, 10}, {100, 30, 9}}));
    EXPECT_FALSE(is_shown({{0, 1, 9}, {100, 30, 30}}));
}

TEST(MotorRecord, TakesThreeMetresOrATenthOfTheHeightForTheGround) {
    EXPECT_TRUE(is_shown({{0, 1, 5}, {2.9, 1, 5}, {20, 30, 90}}));
    EXPECT_FALSE(is_shown({{0, 1, 5}, {3.1, 1, 5}, {20, 30, 90}}));
    EXPECT_TRUE(is_shown({{0, 1, 5}, {9.9, 1, 5}, {100, 30, 90}}));
    EXPECT_FALSE(is_shown({{0, 1, 5}, {10.1, 1, 5}, {100, 30, 90}}));
    // Of the heights two percent below and above do not count.
    EXPECT_TRUE(is_shown({{-50, 25, 20}, {0, 1, 300}, {100, 30, 681}}));
    EXPECT_FALSE(is_shown({{-50, 25, 22}, {0, 1, 300}, {100, 30, 679}}));
    EXPECT_TRUE(is_shown({{0, 25, 25}, {8, 1, 100}, {50, 30, 855}, {100, 30, 21}}));
    EXPECT_FALSE(is_shown({{0, 25, 25}, {8, 1, 100}, {50, 30, 856}, {100, 30, 20}}));
}

TEST(MotorRecord, TakesTheLowerQuartileOnTheGroundForIdleAndTheHighestFiftiethForRunning) {
    EXPECT_TRUE(is_shown({{0, 1, 11}, {0, 25, 30}, {100, 30, 60}}));
    EXPECT_FALSE(is_shown({{0, 1, 10}, {0, 25, 31}, {100, 30, 60}}));
    EXPECT_TRUE(is_shown({{0, 1, 500}, {100, 1, 480}, {100, 30, 21}}));
    EXPECT_FALSE(is_shown({{0, 1, 500}, {100, 1, 481}, {100, 30, 20}}));
}

TEST(MotorRecord, TakesATenthOfTheWayToRunningForIdleAndAQuarterForFlight) {
    // Idle is 1 W, running 101 W: first with a throttle that opens on the ground, then with one of 0 in the air.
    const auto opens_at = [](double power_w) {
        return record_of({{0, 1, 20}, {100, 101, 60, 60}, {0, 1, 20}, {0, power_w, 5, 60}, {0, 1, 20}}).warnings;
    };
    EXPECT_THAT(opens_at(10.5), testing::ElementsAre(HasSubstr("5 samples of the throttle are removed")));
    EXPECT_THAT(opens_at(11.5), testing::IsEmpty());
    const auto flies_at = [](double power_w) {
        return record_of({{0, 1, 20}, {100, 101, 60, 60}, {100, power_w, 40}, {0, 1, 20}}).warnings;
    };
    EXPECT_THAT(flies_at(26.5), testing::ElementsAre(HasSubstr("the latter is used there")));
    EXPECT_THAT(flies_at(25.5), testing::IsEmpty());
}

}  // namespace
}  // namespace flightwatt::flight
