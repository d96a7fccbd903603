#include "flight/select/voltage_dropouts.h"

#include "helpers/selected_tracks.h"

#include <functional>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;

/// A sample a second of 15 V and 10 A, of which those that drop have other voltages and currents.
FlightSeries battery(std::size_t samples, const std::function<bool(std::size_t)>& drops, double dropped_v = 0.0,
                     double dropped_a = 0.0, const char* message = "BAT") {
    const std::string source = message;
    FlightSeries series;
    series.tracks = {{"voltage_v", source + ".Volt", "0"},
                     {"current_a", source + ".Curr", "0"},
                     {"power_w", source + ".Volt * " + source + ".Curr", "0"}};
    for (std::size_t i = 0; i < samples; ++i) {
        const double ripple = 0.01 * static_cast<double>(i % 7);
        const double volts = drops(i) ? dropped_v : 15.0 + ripple;
        const double amperes = drops(i) ? dropped_a : 10.0 + ripple;
        for (auto& track : series.tracks) track.time_s.push_back(static_cast<double>(i));
        series.tracks[0].value.push_back(volts);
        series.tracks[1].value.push_back(amperes);
        series.tracks[2].value.push_back(volts * amperes);
    }
    return series;
}

std::function<bool(std::size_t)> between(std::size_t begin, std::size_t end) {
    return [=](std::size_t i) { return i >= begin && i < end; };
}

double energy_j(const FlightSeries& series) {
    const auto power = power_track(series);
    return integrated(power.time_s, power.value, 0.0, 199.0);
}

TEST(VoltageDropouts, OfAnyLengthAreNoPowerOf0) {
    const auto sound_j = energy_j(battery(200, between(0, 0)));
    for (const std::size_t length : {1, 2, 4, 20, 90}) {
        const auto series = battery(200, between(50, 50 + length));
        EXPECT_NEAR(energy_j(series), sound_j, 0.005 * sound_j) << length;
        EXPECT_EQ(select_track(series, "voltage_v").time_s.size(), 200 - length);
        EXPECT_EQ(select_track(series, "current_a").time_s.size(), 200 - length);
    }
    EXPECT_THAT(
        warnings_of(battery(200, between(50, 70))),
        Contains("the voltage (BAT.Volt) is about 0 V for 20.0 s in all, between others, the longest 20.0 s from "
                 "50.0 s on: these 20 samples are removed, and the power is interpolated across them"));
}

TEST(VoltageDropouts, KeepACurrentThatIsMeasured) {
    const auto series = battery(200, between(50, 70), 1.4, 10.0);
    EXPECT_EQ(select_track(series, "current_a").time_s.size(), 200U);
    EXPECT_EQ(power_track(series).time_s.size(), 180U);
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(50, 70), 1.6, 10.0)).series) << "more than a tenth";
}

TEST(VoltageDropouts, AreBetweenOthersAndTheLesserPart) {
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(0, 50))).series) << "before the pack is connected";
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(150, 200))).series);
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(0, 200), 0.0, 10.0)).series) << "not measured at all";
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(50, 151))).series);
    EXPECT_TRUE(without_voltage_dropouts(battery(200, between(50, 150))).series);
}

TEST(VoltageDropouts, AreNotOfDevicesThatAreSwitchedOff) {
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(50, 70), 0.0, 0.0, "POWER_DEVICE")).series);
    EXPECT_FALSE(without_voltage_dropouts(battery(200, between(50, 70), 0.0, 0.0, "ESC")).series);
}

TEST(VoltageDropouts, LeaveAPowerWithASensorOfItsOwn) {
    auto series = battery(200, between(50, 70));
    for (auto& track : series.tracks) {
        track.device.clear();
        track.source = track.name;
    }
    series.tracks[2].value.assign(200, 150.0);
    EXPECT_EQ(without_voltage_dropouts(series).series->tracks[2].time_s.size(), 200U);
    EXPECT_EQ(without_voltage_dropouts(series).series->tracks[0].time_s.size(), 180U);
}

}  // namespace
}  // namespace flightwatt::flight
