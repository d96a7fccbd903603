#include "flight/segment/flight_grid.h"

#include "flight/segment.h"
#include "flight/select.h"
#include "helpers/flown_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A wing of Paparazzi from 60 to 520 s, in the air at 15 m/s from 100 to 470 s, whose altitude is a receiver's.
FlightSeries wing_with_receiver(const std::function<double(double time_s, double altitude_m)>& altitude) {
    auto columns = test::columns_of(test::sortie(100, 750.0));
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        const double t = columns.time_s[i];
        columns.altitude_m[i] = altitude(t, columns.altitude_m[i]);
        columns.ground_speed_m_per_s.push_back(t > 100.0 && t < 469.0 ? 15.0 : 0.4);
    }
    auto series = test::series_of(columns);
    for (auto& track : series.tracks)
        if (track.name == "altitude_m") track.source = "ESTIMATOR.z";
    return series;
}

Track& track_named(FlightSeries& series, const std::string& name) {
    return *std::ranges::find(series.tracks, name, &Track::name);
}

/// Appends a time without a message and then a rebooted aircraft: no fix, and an altitude and a speed of 0.
void reboot(FlightSeries& series, double at_s) {
    Track fix{.name = "fix", .source = "GPS.mode", .time_s = {0.0, 519.0}, .value = {1.0, 1.0}};
    for (double t = at_s; t < at_s + 60.0; t += 1.0) {
        for (auto& track : series.tracks) {
            if (track.name == "ground_speed_m_per_s") continue;  // it has none without a fix
            track.time_s.push_back(t);
            track.value.push_back(0.0);
        }
        fix.time_s.push_back(t);
        fix.value.push_back(0.0);
    }
    series.tracks.push_back(fix);
}

TEST(FlightGrid, ARebootAfterAPauseSaysNothingOfTheGround) {
    auto series = wing_with_receiver([](double, double altitude_m) { return altitude_m; });
    reboot(series, 820.0);
    const auto phases = segment(select_tracks(series));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].ground_altitude_m, 750.0, 1.0);
    EXPECT_NEAR(phases.sorties[0].start_s(), 101.0, 3.0);
    EXPECT_NEAR(phases.sorties[0].end_s(), 469.0, 3.0);
}

TEST(FlightGrid, AnAltitudeWithoutAFixCountsOnlyIfThereNeverIsOne) {
    auto series = wing_with_receiver([](double, double altitude_m) { return altitude_m; });
    const auto all = track_named(series, "altitude_m").time_s.size();
    Track fix{.name = "fix", .source = "GPS.mode", .time_s = {0.0, 300.0, 310.0}, .value = {1.0, 0.0, 1.0}};
    series.tracks.push_back(fix);
    const auto with_loss = make_grid(select_tracks(series)).altitude_time_s;
    EXPECT_LT(with_loss.size(), all);
    EXPECT_THAT(with_loss, testing::Each(testing::AnyOf(testing::Le(0.0), testing::Ge(310.0))))
        << "between a state with a fix and one without it, it is not known";
    track_named(series, "fix").value.assign(3, 0.0);
    EXPECT_EQ(make_grid(select_tracks(series)).altitude_time_s.size(), all) << "a barometer's";
    track_named(series, "fix").value = {1.0, 0.0, 1.0};
    track_named(series, "altitude_m").source = "BARO.Alt";
    EXPECT_EQ(make_grid(select_tracks(series)).altitude_time_s.size(), all);
}

TEST(FlightGrid, ARestLastsWhileTheAltitudeOfAReceiverWanders) {
    // 20 m up and down within a minute, as receivers without a barometer do.
    const auto series = wing_with_receiver([](double t, double altitude_m) {
        return t < 100.0 || t > 470.0 ? altitude_m + 10.0 * std::sin((t - 60.0) / 8.0) : altitude_m;
    });
    const auto phases = segment(select_tracks(series));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].start_s(), 100.0, 6.0);
    EXPECT_NEAR(phases.sorties[0].end_s(), 469.0, 6.0);
    EXPECT_TRUE(phases.ground_events.empty()) << "idle and slow is at rest";
}

TEST(FlightGrid, MotorAndMotionShowTheEndsOfAFlightAsLowAsTheAltitudeWanders) {
    auto series = wing_with_receiver([](double t, double altitude_m) {
        return 750.0 + 0.2 * (altitude_m - 750.0) + 15.0 * std::sin((t - 470.0) / 8.0);
    });
    const auto phases = segment(select_tracks(series));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].start_s(), 99.0, 2.0) << "the motor starts";
    EXPECT_NEAR(phases.sorties[0].end_s(), 469.0, 3.0) << "the motion ends";
    EXPECT_THAT(phases.warnings, Contains(HasSubstr("take-off and landing are uncertain")));
}

TEST(FlightGrid, AJumpWithTheMotorOnDoesNotSplitAFlight) {
    const auto series =
        wing_with_receiver([](double t, double altitude_m) { return t > 250.0 ? altitude_m + 115.0 : altitude_m; });
    EXPECT_EQ(segment(select_tracks(series)).sorties.size(), 1U);
}

TEST(FlightGrid, IntervalAroundATimeIsThatOfItsSamples) {
    const std::vector<double> sample_s{10.0, 11.0, 31.0};
    EXPECT_EQ(interval_around_s(sample_s, 10.5), 1.0);
    EXPECT_EQ(interval_around_s(sample_s, 20.0), 20.0);
    EXPECT_EQ(interval_around_s(sample_s, 7.0), 3.0) << "to the nearest one beyond the ends";
    EXPECT_EQ(interval_around_s(sample_s, 36.0), 5.0);
    EXPECT_TRUE(std::isinf(interval_around_s({}, 1.0)));
}

}  // namespace
}  // namespace flightwatt::flight
