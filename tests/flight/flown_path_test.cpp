#include "flight/flown_path.h"

#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

Track track(const std::string& name, const std::vector<double>& time_s, const std::vector<double>& value) {
    Track made;
    made.name = name;
    made.source = "TEST";
    made.time_s = time_s;
    made.value = value;
    return made;
}

PhaseSpan cruise(double start_s, double end_s) {
    PhaseSpan span;
    span.start.time_s = start_s;
    span.end.time_s = end_s;
    return span;
}

/// To the east at 10 m/s, climbing at 0.5 m/s, from 1000 m east of the origin.
FlightSeries eastward() {
    FlightSeries series;
    series.file = "e.csv";
    const std::vector<double> times_s{0.0, 50.0, 100.0, 200.0};
    series.tracks = {track("altitude_m", times_s, {100.0, 125.0, 150.0, 200.0}),
                     track("east_m", times_s, {1000.0, 1500.0, 2000.0, 3000.0}),
                     track("north_m", times_s, {7.0, 7.0, 7.0, 7.5}),
                     track("airspeed_m_per_s", {0.0, 99.999, 100.0, 200.0}, {12.0, 12.0, 14.0, 14.0})};
    return series;
}

TEST(FlownPath, HasAPlaceEveryThirtySeconds) {
    const auto path = flown_path(select_tracks(eastward()), cruise(20.0, 200.0));
    EXPECT_FALSE(path.is_geographic);
    ASSERT_EQ(path.waypoints.size(), 7U);
    EXPECT_DOUBLE_EQ(path.waypoints.front().east_m, 0.0);
    EXPECT_DOUBLE_EQ(path.waypoints.front().duration_s, 0.0);
    EXPECT_DOUBLE_EQ(path.waypoints.front().altitude_m, 110.0);
    double duration_s = 0.0;
    for (const auto& place : path.waypoints) duration_s += place.duration_s;
    EXPECT_NEAR(duration_s, 180.0, 1e-9);
    EXPECT_NEAR(path.waypoints[2].east_m, 600.0, 1e-9);
    EXPECT_NEAR(path.waypoints[2].altitude_m, 140.0, 1e-9);
    EXPECT_NEAR(path.waypoints[2].airspeed_m_per_s, 12.0, 1e-9);
    // From 80 to 110 s: two thirds at 12 m/s, a third at 14 m/s, by their cubes.
    EXPECT_NEAR(path.waypoints[3].airspeed_m_per_s, std::cbrt((2.0 * 1728.0 + 2744.0) / 3.0), 1e-3);
    // One that is short has its ends.
    EXPECT_EQ(flown_path(select_tracks(eastward()), cruise(20.0, 30.0)).waypoints.size(), 2U);
}

TEST(FlownPath, FollowsBends) {
    auto series = eastward();
    const double radius_m = 60.0;
    std::vector<double> times_s;
    std::vector<double> east_m;
    std::vector<double> north_m;
    for (int i = 0; i <= 200; ++i) {
        times_s.push_back(i);
        east_m.push_back(radius_m * std::sin(12.0 * i / radius_m));
        north_m.push_back(radius_m * std::cos(12.0 * i / radius_m));
    }
    series.tracks[1] = track("east_m", times_s, east_m);
    series.tracks[2] = track("north_m", times_s, north_m);
    const auto path = flown_path(select_tracks(series), cruise(0.0, 200.0));
    double length_m = 0.0;
    for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
        const auto& a = path.waypoints[i - 1];
        const auto& b = path.waypoints[i];
        length_m += std::hypot(b.east_m - a.east_m, b.north_m - a.north_m);
        EXPECT_NEAR(b.altitude_m - a.altitude_m, 0.5 * b.duration_s, 1e-9);
    }
    EXPECT_NEAR(length_m, 2400.0, 0.03 * 2400.0);
    EXPECT_LT(path.waypoints.size(), 120U) << "fewer than one a second";
}

TEST(FlownPath, IsInDegreesWhereTheLogIs) {
    auto series = eastward();
    series.tracks[1].name = "latitude_deg";
    series.tracks[2].name = "longitude_deg";
    const auto path = flown_path(select_tracks(series), cruise(0.0, 60.0));
    EXPECT_TRUE(path.is_geographic);
    EXPECT_DOUBLE_EQ(path.waypoints.front().east_m, 1000.0);
}

/// Missions fly a rotorcraft's speed as one over ground: with its airspeed, 12 m/s here, they would end too early.
TEST(FlownPath, HasTheSpeedOfARotorcraftOverGround) {
    auto series = eastward();
    series.firmware = "rotorcraft";
    const auto path = flown_path(select_tracks(series), cruise(20.0, 80.0));
    ASSERT_EQ(path.waypoints.size(), 3U);
    EXPECT_NEAR(path.waypoints[1].airspeed_m_per_s, std::hypot(10.0, 0.5), 1e-9);
    std::erase_if(series.tracks, [](const Track& is) { return is.name == "airspeed_m_per_s"; });
    EXPECT_NEAR(flown_path(select_tracks(series), cruise(20.0, 80.0)).waypoints[2].airspeed_m_per_s,
                std::hypot(10.0, 0.5), 1e-9);
}

TEST(FlownPath, NeedsAirspeedAltitudeAndPosition) {
    for (const std::string missing : {"airspeed_m_per_s", "altitude_m", "north_m"}) {
        auto series = eastward();
        std::erase_if(series.tracks, [&](const Track& is) { return is.name == missing; });
        EXPECT_EQ(test::rejected([&] {
                      flown_path(select_tracks(series), cruise(0.0, 60.0));
                  }).find("e.csv: has no " + missing),
                  0U);
    }
}

}  // namespace
}  // namespace flightwatt::flight
