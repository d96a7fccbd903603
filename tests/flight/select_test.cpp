#include "flight/load_flight.h"
#include "flight/telemetry_series.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;

FlightSeries series_of(const std::string& text) {
    return flight_series(parse_telemetry(text, "x.data", std::nullopt, flight_messages()), "20");
}

/// Throttle 50 %, but for `manual_s` 0 as in manual mode, while the commands continue.
FlightSeries with_commands(double manual_s, const std::string& commands, int until_s = 200) {
    std::string text;
    for (int i = 0; i <= 200; ++i) {
        text += fmt::format("{} 20 ENERGY {} 11. 2. 22. 0.1 1.\n", i, i < 100 || i > 100 + manual_s ? 50 : 0);
        if (i % 5 == 0 && i <= until_s) text += fmt::format("{} 20 COMMANDS {}\n", i, commands);
    }
    return series_of(text);
}

TEST(SelectedThrottle, IsTheCommandsWhereItIdlesInManualMode) {
    const auto lowest = [](const FlightSeries& series) {
        const auto throttle = select_track(series, "throttle_percent");
        return *std::ranges::min_element(throttle.value);
    };
    const auto manual = with_commands(30.0, "4800,-20,30");
    EXPECT_EQ(lowest(manual), 50.0);
    EXPECT_THAT(warnings_of(manual), Contains(HasSubstr("ENERGY.throttle is idle while COMMANDS.throttle is not for "
                                                        "30 s, first from 100 s: the latter is used there")));
    EXPECT_EQ(lowest(with_commands(29.0, "4800,-20,30")), 0.0) << "half a minute";
    EXPECT_EQ(lowest(with_commands(40.0, "4800,-20,30", 125)), 0.0) << "what stopped states nothing";
    EXPECT_EQ(lowest(with_commands(40.0, "1900,-20,30")), 0.0) << "less than any flight takes";
    EXPECT_NEAR(lowest(with_commands(40.0, "1930,-20,30")), 20.1, 0.01);
}

TEST(SelectedThrottle, IsTheFirstCommandWhereItIsNeverNegative) {
    const auto series_with = [](int first) {
        std::string text;
        for (int i = 0; i <= 20; ++i) text += fmt::format("{} 20 COMMANDS {},7,8\n", i, i == 9 ? first : 96 * i);
        return series_of(text);
    };
    EXPECT_EQ(select_track(series_with(0), "throttle_percent").source, "COMMANDS.throttle");
    EXPECT_EQ(select_track(series_with(0), "throttle_percent").value.back(), 20.0);
    EXPECT_EQ(select_track(series_with(-1), "throttle_percent").source, "") << "a roll command";
}

TEST(SelectedThrottle, IsOfCommandsEveryTwoSecondsWherePowerIsMeasured) {
    const auto has_throttle = [](double interval_s, const std::string& power) {
        std::string text;
        for (int i = 0; i <= 20; ++i)
            text += fmt::format("{} 20 COMMANDS {},7,8\n{} {}\n", interval_s * i, 96 * i, i, power);
        return !select_track(series_of(text), "throttle_percent").empty();
    };
    EXPECT_TRUE(has_throttle(1.9, "20 ENERGY 11. 2. 5 0."));
    EXPECT_FALSE(has_throttle(2.1, "20 ENERGY 11. 2. 5 0."));
    EXPECT_TRUE(has_throttle(2.1, "20 ESTIMATOR 1. 0."));
}

struct Part {
    double throttle;
    int samples;
    double power_w = 5.0;
};

/// Whether a throttle is taken for a fraction of 1.
bool is_fraction(const std::vector<Part>& parts) {
    FlightSeries series;
    series.tracks = {{.name = "throttle_percent", .source = "ENERGY.throttle"}, {.name = "power_w", .source = "CSV"}};
    auto& throttle = series.tracks[0];
    auto& power = series.tracks[1];
    for (const auto& part : parts) {
        for (int i = 0; i < part.samples; ++i) {
            throttle.time_s.push_back(static_cast<double>(throttle.time_s.size()));
            throttle.value.push_back(part.throttle);
            power.value.push_back(part.power_w);
        }
    }
    power.time_s = throttle.time_s;
    return select_track(series, "throttle_percent").value.back() > 10.0;
}

TEST(SelectedThrottle, IsAFractionWhereItRunsToOneAndIsOftenNoWholePercent) {
    EXPECT_TRUE(is_fraction({{0.0, 5}, {0.5, 10}}));
    EXPECT_FALSE(is_fraction({{0.0, 5}, {0.5, 9}}));
    EXPECT_TRUE(is_fraction({{0.055, 10}, {1.0, 5}}));
    EXPECT_FALSE(is_fraction({{0.045, 10}, {1.0, 5}})) << "idle";
    EXPECT_TRUE(is_fraction({{0.1, 10}, {0.21, 1}}));
    EXPECT_FALSE(is_fraction({{0.1, 10}, {0.19, 1}}));
    EXPECT_TRUE(is_fraction({{0.5, 10}, {1.49, 1}}));
    EXPECT_FALSE(is_fraction({{0.5, 10}, {1.51, 1}}));
    EXPECT_TRUE(is_fraction({{-0.045, 1}, {0.5, 10}}));
    EXPECT_FALSE(is_fraction({{-0.055, 1}, {0.5, 10}}));
}

TEST(SelectedThrottle, IsAFractionWherePowerRisesToThreeTimesThatAtIdleAndAWattWithIt) {
    EXPECT_TRUE(is_fraction({{0.0, 10, 2.0}, {0.9, 10, 7.1}}));
    EXPECT_FALSE(is_fraction({{0.0, 10, 2.0}, {0.9, 10, 6.9}}));
    EXPECT_TRUE(is_fraction({{0.0, 9, 2.0}, {0.9, 10, 6.9}})) << "not known";
}

}  // namespace
}  // namespace flightwatt::flight
