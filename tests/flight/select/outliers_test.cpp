#include "flight/select/outliers.h"

#include "helpers/selected_tracks.h"

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

Track altitude(std::vector<double> values) {
    Track track{.name = "altitude_m", .source = "ESTIMATOR.z", .value = std::move(values)};
    for (std::size_t i = 0; i < track.value.size(); ++i) track.time_s.push_back(static_cast<double>(i));
    return track;
}

/// A track of 100 samples of `value`, of which `changed` are others.
Track track_with(const char* name, double value, std::initializer_list<std::pair<std::size_t, double>> changed) {
    Track track{.name = name, .source = "ENERGY.x", .value = std::vector<double>(100, value)};
    for (std::size_t i = 0; i < track.value.size(); ++i) track.time_s.push_back(static_cast<double>(i));
    for (const auto& [i, other] : changed) track.value[i] = other;
    return track;
}

TEST(PhysicalBounds, LeaveOutFewSamplesAndBelieveNothingOfATrackOfMany) {
    std::vector<double> heights(100, 50.0);
    heights[3] = 1e308;
    heights[40] = -116249.0;
    EXPECT_EQ(within_bounds(altitude(heights)).value, std::vector<double>(98, 50.0));
    for (std::size_t i = 0; i < 9; ++i) heights[i] = 1e6;
    EXPECT_EQ(within_bounds(altitude(heights)).value, std::vector<double>(90, 50.0));
    heights[9] = 1e6;
    EXPECT_TRUE(within_bounds(altitude(heights)).empty());
    EXPECT_EQ(within_bounds(altitude({1.0, 2.0})), altitude({1.0, 2.0}));
}

TEST(PhysicalBounds, LeaveOutWhatLiesBeyondThem) {
    struct Bounds {
        const char* name;
        double low;
        double high;
    };
    const std::vector<Bounds> all{{"altitude_m", -500.0, 20e3},
                                  {"throttle_percent", -5.0, 105.0},
                                  {"voltage_v", 0.0, 500.0},
                                  {"current_a", -2e3, 2e3},
                                  {"power_w", -1e5, 1e5},
                                  {"charge_ah", -1e4, 1e4},
                                  {"energy_wh", -1e5, 1e5},
                                  {"ground_speed_m_per_s", -1.0, 300.0},
                                  {"airspeed_m_per_s", -50.0, 300.0},
                                  {"wind_speed_m_per_s", 0.0, 100.0},
                                  {"wind_east_m_per_s", -100.0, 100.0},
                                  {"wind_north_m_per_s", -100.0, 100.0},
                                  {"climb_m_per_s", -300.0, 300.0},
                                  {"air_temperature_c", -80.0, 100.0},
                                  {"battery_temperature_c", -80.0, 200.0}};
    for (const auto& [name, low, high] : all) {
        SCOPED_TRACE(name);
        const auto kept = [name = name, low = low](double value) {
            return within_bounds(track_with(name, low, {{7, value}})).value.size();
        };
        EXPECT_EQ(kept(low - 0.1), 99U);
        EXPECT_EQ(kept(low + 0.1), 100U);
        EXPECT_EQ(kept(high - 0.1), 100U);
        EXPECT_EQ(kept(high + 0.1), 99U);
    }
    EXPECT_FALSE(physical_bounds("block").has_value());
}

TEST(PhysicalBounds, AreKeptByTheChosenTrack) {
    FlightSeries series;
    std::vector<double> heights;
    for (int i = 0; i < 100; ++i) heights.push_back(i == 7 ? 1e7 : i);
    series.tracks.push_back(altitude(heights));
    EXPECT_EQ(select_track(series, "altitude_m").value.size(), 99U);
    EXPECT_EQ(warnings_of(series).at(0),
              "1 of 100 samples of altitude_m (ESTIMATOR.z) are removed: 1 beyond physical bounds");
}

std::size_t removed(const Track& track, const Track& throttle = {}) {
    return track.value.size() - remove_outliers(track, {}, throttle).value.size();
}

/// A copter whose ground speed was -0.02 m/s on average in a hover was an internal error.
TEST(Outliers, AreNotSpeedsBelowZeroWhichAreNone) {
    for (const auto* name : {"ground_speed_m_per_s", "airspeed_m_per_s"}) {
        const auto chosen = remove_outliers(track_with(name, -0.02, {{3, 1.5}}));
        ASSERT_EQ(chosen.value.size(), 100U);
        EXPECT_EQ(chosen.value[0], 0.0);
        EXPECT_EQ(chosen.value[3], 1.5);
    }
    EXPECT_EQ(remove_outliers(track_with("climb_m_per_s", -0.02, {})).value[0], -0.02);
}

TEST(Outliers, AreSpikesOfPowerAndCurrent) {
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{50, 66.0}, {51, 66.0}})), 2U) << "three times 20 W, and 5 W";
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{50, 64.5}, {51, 64.5}})), 0U);
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{50, 66.0}, {51, 66.0}, {52, 66.0}})), 0U) << "held";
    EXPECT_EQ(removed(track_with("current_a", 2.0, {{50, 7.1}})), 1U) << "three times 2 A, and 1 A";
    EXPECT_EQ(removed(track_with("current_a", 2.0, {{50, 6.9}})), 0U);
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{49, 34.0}, {50, 67.0}})), 0U) << "less than twice its neighbour";
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{49, 33.0}, {50, 67.0}})), 1U);
    auto of_ten = track_with("power_w", 20.0, {{5, 66.0}});
    of_ten.time_s.resize(10);
    of_ten.value.resize(10);
    EXPECT_EQ(removed(of_ten), 1U);
    of_ten.time_s.pop_back();
    of_ten.value.pop_back();
    EXPECT_EQ(removed(of_ten), 0U) << "too few to be assessed";
}

TEST(Outliers, AreSpikesOfVoltage) {
    EXPECT_EQ(removed(track_with("voltage_v", 10.0, {{50, 6.9}})), 1U);
    EXPECT_EQ(removed(track_with("voltage_v", 10.0, {{50, 7.1}})), 0U);
    EXPECT_EQ(removed(track_with("voltage_v", 10.0, {{50, 6.9}, {51, 6.9}, {52, 6.9}})), 0U);
}

TEST(Outliers, AreSamplesOutOfTheOrderOfACounter) {
    const auto counter = [](double by) {
        auto track = track_with("energy_wh", 0.0, {});
        for (std::size_t i = 0; i < 100; ++i) track.value[i] = 0.1 * static_cast<double>(i);  // to 9.9 Wh
        track.value[50] += by;
        return track;
    };
    EXPECT_EQ(removed(counter(-0.21)), 1U);
    EXPECT_EQ(removed(counter(-0.18)), 0U) << "less than 1 % below the one before";
    EXPECT_EQ(removed(counter(0.21)), 1U);
    EXPECT_EQ(removed(counter(0.18)), 0U);
}

TEST(Outliers, AreDropoutsWhileTheThrottleIsOpen) {
    const auto throttle = [](double percent) { return track_with("throttle_percent", percent, {}); };
    const auto dropout = track_with("power_w", 20.0, {{50, 0.0}, {51, 0.0}, {52, 0.0}});
    EXPECT_EQ(removed(dropout, throttle(31.0)), 3U);
    EXPECT_EQ(removed(dropout, throttle(29.0)), 0U);
    EXPECT_EQ(removed(dropout), 0U) << "no throttle is known";
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{50, 0.0}, {51, 0.0}, {52, 0.0}, {53, 0.0}}), throttle(50.0)), 0U);
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{49, 4.9}, {50, 0.0}}), throttle(50.0)), 0U)
        << "next to less than a quarter of the median";
    EXPECT_EQ(removed(track_with("power_w", 20.0, {{49, 5.1}, {50, 0.0}}), throttle(50.0)), 1U);
}

TEST(Outliers, AreNotThePulsesOfAMotor) {
    for (const auto& throttle : {Track{}, track_with("throttle_percent", 50.0, {})}) {
        auto pulsed = track_with("power_w", 0.0, {});
        for (std::size_t i = 0; i < 100; i += 2) pulsed.value[i] = 40.0;
        const auto chosen = remove_outliers(pulsed, {}, throttle);
        EXPECT_EQ(chosen.value, pulsed.value) << "each pulse stands far beyond its neighbours, which are 0";
        ASSERT_EQ(chosen.notes.size(), 1U);
        EXPECT_THAT(chosen.notes.front(), testing::HasSubstr("49 % of"));
        EXPECT_THAT(chosen.notes.front(), testing::HasSubstr("a pulsed motor, or a sensor that fails"));
    }
}

}  // namespace
}  // namespace flightwatt::flight
