#include "base/statistics.h"
#include "battery/identification/circuit_problem.h"
#include "helpers/aged_flights.h"
#include "helpers/synthetic_discharge.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

// How the resistances of flights scatter, and how they continue.
// What each flight alone states of its pack, as that ages.
namespace flightwatt::battery {
namespace {

std::optional<FlightResistance> resistance(double value_ohm, double error_ohm = 1e-3) {
    return FlightResistance{value_ohm, error_ohm, 10.0, {value_ohm - 2e-3, value_ohm + 2e-3}};
}

TEST(FlightResistance, ScattersByMoreThanItsErrors) {
    const auto scatter = [](const std::vector<std::optional<FlightResistance>>& all) {
        return resistance_scatter_ohm(all, 0.1);
    };
    EXPECT_DOUBLE_EQ(scatter({resistance(0.1)}), 0.015) << "one flight states nothing about others";
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

TEST(StateOfHealth, HasTheResistanceOfTheFlight) {
    std::vector<DischargeRecord> records;
    const std::vector<double> true_ohm{0.06, 0.08, 0.12};
    for (std::size_t f = 0; f < true_ohm.size(); ++f) {
        auto pack = test::known_pack();
        pack.resistance_ohm = true_ohm[f];
        records.push_back(test::discharge_record(test::synthetic_discharge(pack, {}, 40 + f)));
    }
    const auto found = estimate_state_of_health(fit_circuit_jointly(records, 3), false);
    for (std::size_t f = 0; f < true_ohm.size(); ++f) {
        ASSERT_TRUE(found[f].resistance);
        EXPECT_NEAR(found[f].resistance->value_ohm, true_ohm[f], 0.004) << f;
        EXPECT_LT(found[f].resistance->standard_error_ohm, 0.01) << f;
    }
}

/// The slope over the date, by least squares.
double slope_of(const std::vector<double>& day, const std::vector<double>& value) {
    const double middle = mean(day);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t f = 0; f < day.size(); ++f) {
        squares += std::pow(day[f] - middle, 2);
        products += (day[f] - middle) * value[f];
    }
    return products / squares;
}

/// Resistance and capacity that one pack's flights show.
struct Shown {
    std::vector<double> resistance_ohm;
    std::vector<double> log_ratio;
};

Shown shown_by(const test::AgedFlights& aged) {
    Shown shown;
    for (const auto& wear : estimate_state_of_health(fit_circuit_jointly(aged.records, 3), true)) {
        EXPECT_TRUE(wear.resistance && wear.capacity);
        if (!wear.resistance || !wear.capacity) continue;
        shown.resistance_ohm.push_back(wear.resistance->value_ohm);
        shown.log_ratio.push_back(std::log(wear.capacity->ratio));
        EXPECT_LT(wear.capacity->ratio_interval.low, wear.capacity->ratio);
        EXPECT_GT(wear.capacity->ratio_interval.high, wear.capacity->ratio);
    }
    return shown;
}

TEST(StateOfHealth, OfAnAgeingPackIsNotUnderstated) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const test::Ageing ageing{0.0001, 0.001};
        const auto aged = test::aged_flights(ageing, seed);
        const auto shown = shown_by(aged);
        ASSERT_EQ(shown.log_ratio.size(), aged.day.size());
        EXPECT_NEAR(slope_of(aged.day, shown.resistance_ohm), ageing.ohm_a_day, 0.2 * ageing.ohm_a_day) << seed;
        EXPECT_NEAR(slope_of(aged.day, shown.log_ratio), -ageing.part_a_day, 0.2 * ageing.part_a_day) << seed;
    }
}

TEST(StateOfHealth, IsNoneWhereNothingTellsIt) {
    const std::vector records{test::discharge_record(test::synthetic_discharge(test::known_pack(), {}, 61)),
                              test::discharge_record(test::synthetic_discharge(test::known_pack(), {}, 62))};
    const auto aligned = fit_circuit_jointly(records, 3);
    for (const auto& wear : estimate_state_of_health(aligned, false))
        EXPECT_FALSE(wear.capacity) << "it was not asked for";
    test::SyntheticDischarge shallow;
    shallow.duration_s = 320.0;
    const std::vector few{test::discharge_record(test::synthetic_discharge(test::known_pack(), shallow, 63)),
                          test::discharge_record(test::synthetic_discharge(test::known_pack(), shallow, 64))};
    for (const auto& wear : estimate_state_of_health(fit_circuit_jointly(few, 3), true))
        EXPECT_FALSE(wear.capacity) << "it draws too little";
}

}  // namespace
}  // namespace flightwatt::battery
