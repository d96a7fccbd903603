#include "flight/select/power.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

struct Samples {
    int count;
    double power_w;
    double product_w;  ///< voltage times current
};

/// A log with both of them.
FlightSeries series_of(const std::vector<Samples>& samples) {
    FlightSeries series;
    series.tracks = {{.name = "power_w", .source = "ENERGY.power"},
                     {.name = "power_w", .source = "ENERGY.voltage * ENERGY.current"}};
    for (const auto& [count, power_w, product_w] : samples) {
        for (int i = 0; i < count; ++i) {
            const auto time_s = static_cast<double>(series.tracks[0].time_s.size());
            for (auto& track : series.tracks) track.time_s.push_back(time_s);
            series.tracks[0].value.push_back(power_w);
            series.tracks[1].value.push_back(product_w);
        }
    }
    return series;
}

bool takes_power(const std::vector<Samples>& samples) {
    return select_power(series_of(samples)).source == "ENERGY.power";
}

TEST(PowerSource, IsNotAPowerOfWhichMostSamplesAreAFifthAwayFromVoltageTimesCurrent) {
    EXPECT_TRUE(takes_power({{20, 10.0, 8.4}}));
    EXPECT_FALSE(takes_power({{20, 10.0, 8.2}}));
    EXPECT_TRUE(takes_power({{10, 10.0, 20.0}, {10, 10.0, 10.0}}));
    EXPECT_FALSE(takes_power({{11, 10.0, 20.0}, {10, 10.0, 10.0}}));
    EXPECT_TRUE(takes_power({{9, 10.0, 20.0}}));
    EXPECT_FALSE(takes_power({{10, 10.0, 20.0}}));
    EXPECT_TRUE(takes_power({{20, 5.0, 0.9}})) << "below 1 W rounding and offsets rule";
    EXPECT_FALSE(takes_power({{20, 5.0, 1.1}}));
}

TEST(PowerSource, MayBeOfAnyMessageThatPaparazziHasNot) {
    FlightSeries series;
    series.tracks = {{.name = "power_w", .source = "BAT.Volt*Curr", .time_s = {1.0, 2.0}, .value = {10.0, 11.0}}};
    EXPECT_EQ(select_power(series).value, (std::vector<double>{10.0, 11.0}));
    series.tracks[0].source = "CURR.Volt * CURR.Curr";
    EXPECT_EQ(select_power(series).value, (std::vector<double>{10.0, 11.0}));
    series.tracks[0].value = {0.0, 0.0};
    EXPECT_EQ(select_power(series).not_chosen, std::vector<std::string>{"CURR.Volt * CURR.Curr is 0 throughout"});
}

TEST(PowerSource, IsContradictedInSamplesATenthAndAWattAwayFromVoltageTimesCurrent) {
    const auto contradicted = [](const std::vector<Samples>& samples) {
        return contradicted_times(series_of(samples), "ENERGY.power").size();
    };
    EXPECT_EQ(contradicted({{20, 100.0, 100.0}, {1, 100.0, 88.5}}), 1U);
    EXPECT_EQ(contradicted({{20, 100.0, 100.0}, {1, 100.0, 89.5}}), 0U);
    EXPECT_EQ(contradicted({{20, 100.0, 98.0}, {1, 100.0, 78.5}}), 1U) << "ten times the median difference";
    EXPECT_EQ(contradicted({{20, 100.0, 98.0}, {1, 100.0, 79.5}}), 0U);
    EXPECT_EQ(contradicted({{9, 100.0, 100.0}, {1, 100.0, 50.0}}), 1U);
    EXPECT_EQ(contradicted({{8, 100.0, 100.0}, {1, 100.0, 50.0}}), 0U) << "too few to be assessed";
}

}  // namespace
}  // namespace flightwatt::flight
