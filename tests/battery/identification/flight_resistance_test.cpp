// How the resistances of flights scatter, and how they go on.

#include "battery/identification/flight_resistance.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

std::optional<FlightResistance> resistance(double value_ohm, double error_ohm = 1e-3) {
    return FlightResistance{value_ohm, error_ohm, 10.0, {value_ohm - 2e-3, value_ohm + 2e-3}};
}

TEST(FlightResistance, ScattersByMoreThanItsErrors) {
    const auto scatter = [](const std::vector<std::optional<FlightResistance>>& all) {
        return resistance_scatter_ohm(all, 0.1);
    };
    EXPECT_DOUBLE_EQ(scatter({resistance(0.1)}), 0.015) << "one flight says nothing of others";
    EXPECT_DOUBLE_EQ(scatter({resistance(0.1), std::nullopt}), 0.015);
    // Equal resistances: what stands beforehand counts as one flight of four.
    EXPECT_NEAR(scatter({resistance(0.1), resistance(0.1), resistance(0.1), resistance(0.1)}), 0.0075, 1e-9);
    // Their variance is 4e-4, of which 4e-6 is error.
    const auto wide = scatter({resistance(0.08), resistance(0.10), resistance(0.12)});
    EXPECT_NEAR(wide, std::sqrt((0.015 * 0.015 + 2.0 * (4e-4 - 1e-6)) / 3.0), 1e-9);
}

TEST(FlightResistance, DiffersOfTwoFlightsOrMore) {
    const std::vector<std::optional<FlightResistance>> two{resistance(0.08), std::nullopt, resistance(0.12)};
    const auto scatter = resistance_scatter(two, 0.1);
    ASSERT_TRUE(scatter);
    EXPECT_EQ(scatter->flights, 2U);
    EXPECT_EQ(scatter->sd_ohm, resistance_scatter_ohm(two, 0.1));
    EXPECT_FALSE(resistance_scatter(std::vector{resistance(0.08), std::optional<FlightResistance>()}, 0.1));
}

TEST(FlightResistance, HasATrendFromThreeFlightsOn) {
    EXPECT_FALSE(resistance_trend(std::vector{resistance(0.08), std::optional<FlightResistance>(), resistance(0.09)}));
    const auto rising = resistance_trend(
        std::vector{resistance(0.080), resistance(0.0825), resistance(0.0845), resistance(0.087), resistance(0.089)});
    ASSERT_TRUE(rising);
    EXPECT_EQ(rising->flights, 5U);
    EXPECT_NEAR(rising->ohm_per_flight, 0.00225, 1e-4);
    EXPECT_GT(rising->interval_ohm_a_flight.low, 0.0);
    const auto level = resistance_trend(std::vector{resistance(0.08), resistance(0.10), resistance(0.08)});
    ASSERT_TRUE(level);
    EXPECT_LT(level->interval_ohm_a_flight.low, 0.0);
    EXPECT_GT(level->interval_ohm_a_flight.high, 0.0);
}

}  // namespace
}  // namespace flightwatt::battery
