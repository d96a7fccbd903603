#include "flight/sources/outliers.h"

#include "flight/selected_track.h"

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

Track altitude(std::vector<double> values) {
    Track track{.name = "altitude_m", .source = "ESTIMATOR.z", .value = std::move(values)};
    for (std::size_t i = 0; i < track.value.size(); ++i) track.time_s.push_back(static_cast<double>(i));
    return track;
}

TEST(PhysicalBounds, StandForEveryQuantityThatEnergyRestsOn) {
    for (const auto* name : {"altitude_m", "power_w", "voltage_v", "current_a", "charge_ah", "energy_wh"})
        EXPECT_TRUE(physical_bounds(name).has_value()) << name;
    EXPECT_FALSE(physical_bounds("block").has_value());
}

TEST(PhysicalBounds, LeaveOutFewSamplesAndBelieveNothingOfATrackOfMany) {
    std::vector<double> heights(100, 50.0);
    heights[3] = 1e308;
    heights[40] = -116249.0;
    EXPECT_EQ(within_bounds(altitude(heights)).value, std::vector<double>(98, 50.0));
    for (std::size_t i = 0; i < 11; ++i) heights[i] = 1e6;
    EXPECT_TRUE(within_bounds(altitude(heights)).empty());
    EXPECT_EQ(within_bounds(altitude({1.0, 2.0})), altitude({1.0, 2.0}));
}

TEST(PhysicalBounds, AreTheSameForAltitudeAndThrottleEverywhere) {
    EXPECT_EQ(physical_bounds("altitude_m")->low, -500.0);
    EXPECT_EQ(physical_bounds("altitude_m")->high, 20e3);
    EXPECT_EQ(physical_bounds("throttle_percent")->high, 105.0);
}

TEST(PhysicalBounds, AreKeptByTheChosenTrack) {
    FlightSeries series;
    std::vector<double> heights;
    for (int i = 0; i < 100; ++i) heights.push_back(i == 7 ? 1e7 : i);
    series.tracks.push_back(altitude(heights));
    EXPECT_EQ(select_track(series, "altitude_m").value.size(), 99U);
    EXPECT_EQ(warnings_of(series).at(0),
              "1 of 100 samples of altitude_m (ESTIMATOR.z) are left out: 1 beyond what can be");
}

}  // namespace
}  // namespace flightwatt::flight
