// What each flight alone says of the resistance, and how it goes on.

#include "battery/identification/flight_resistance.h"

#include "helpers/synthetic_discharge.h"

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

std::optional<FlightResistance> resistance(double value_ohm, double error_ohm = 1e-3) {
    return FlightResistance{value_ohm, error_ohm, 10.0, {value_ohm - 2e-3, value_ohm + 2e-3}};
}

TEST(FlightResistance, IsThatOfTheFlight) {
    std::vector<DischargeRecord> records;
    const std::vector<double> true_ohm{0.06, 0.08, 0.12};
    for (std::size_t f = 0; f < true_ohm.size(); ++f) {
        auto pack = test::known_pack();
        pack.resistance_ohm = true_ohm[f];
        records.push_back(test::discharge_record(test::synthetic_discharge(pack, {}, 40 + f)));
    }
    const auto found = flight_resistances(aligned_fit(records, 3));
    for (std::size_t f = 0; f < true_ohm.size(); ++f) {
        ASSERT_TRUE(found[f]);
        EXPECT_NEAR(found[f]->value_ohm, true_ohm[f], 0.008) << f;
        EXPECT_LT(found[f]->standard_error_ohm, 0.01) << f;
    }
    const auto trend = resistance_trend(found);
    ASSERT_TRUE(trend);
    EXPECT_NEAR(trend->ohm_a_flight, 0.03, 0.006);
}

TEST(FlightResistance, HasATrendFromThreeFlightsOn) {
    EXPECT_FALSE(resistance_trend(std::vector{resistance(0.08), std::optional<FlightResistance>(), resistance(0.09)}));
    const auto rising = resistance_trend(
        std::vector{resistance(0.080), resistance(0.0825), resistance(0.0845), resistance(0.087), resistance(0.089)});
    ASSERT_TRUE(rising);
    EXPECT_EQ(rising->flights, 5U);
    EXPECT_NEAR(rising->ohm_a_flight, 0.00225, 1e-4);
    EXPECT_GT(rising->interval_ohm_a_flight.low, 0.0);
    const auto level = resistance_trend(std::vector{resistance(0.08), resistance(0.10), resistance(0.08)});
    ASSERT_TRUE(level);
    EXPECT_LT(level->interval_ohm_a_flight.low, 0.0);
    EXPECT_GT(level->interval_ohm_a_flight.high, 0.0);
}

}  // namespace
}  // namespace flightwatt::battery
