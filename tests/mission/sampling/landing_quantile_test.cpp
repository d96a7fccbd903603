#include "mission/sampling/landing_quantile.h"

#include "base/statistics.h"
#include "helpers/new_flights.h"
#include "helpers/steady_mission.h"
#include "mission/sampled_flights.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::steady_mission;

double quantile_of(const Mission& mission, double probability) {
    return landing_quantile(mission, find_spreads(mission), probability).left_percent;
}

TEST(LandingQuantile, IsThatOfAGaussianWhereDepletionIsLinear) {
    auto mission = steady_mission();
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    for (const double probability : {0.5, 0.8, 0.95, 0.999})
        EXPECT_NEAR(quantile_of(mission, probability),
                    100.0 - 20.0 / 0.36 * (1.0 + 0.05 * normal_quantile(probability)), 2e-3);
    EXPECT_THROW(quantile_of(mission, 0.4), std::invalid_argument);
    EXPECT_THROW(quantile_of(mission, 1.0), std::invalid_argument);
}

TEST(LandingQuantile, IsThatOfStudentTWhereFewFlightsTellTheLevel) {
    auto mission = steady_mission();
    auto& cruise = mission.mechanical->phases[flight::Phase::cruise];
    mission.battery.capacity_ah = 10.0;
    mission.mechanical->phases[flight::Phase::cruise].flights = 3;
    cruise.level_spread = mechanical::LevelSpread{3, 1.0, 0.0, 1.0};
    const double sd_w = std::sqrt(1.0 + 1.0 / 3.0);
    for (const double probability : {0.5, 0.8, 0.95, 0.999}) {
        const double level_w = 20.0 + sd_w * student_of_normal(normal_quantile(probability), 2.0);
        EXPECT_NEAR(quantile_of(mission, probability), 100.0 - level_w / 3.6, 5e-3) << probability;
    }
    const FlightSpreads spreads = find_spreads(mission);
    mission.reserve_soc_percent = quantile_of(mission, 0.95);
    const auto chance = landing_chance(mission, spreads, 0.95);
    EXPECT_NEAR(chance.degrees_of_freedom, 2.0, 1e-9);
    EXPECT_NEAR(chance.below, 0.05, 1e-4);
    EXPECT_NEAR(chance.spare_percent(0.8), quantile_of(mission, 0.8) - mission.reserve_soc_percent, 0.01);
}

/// The models know nothing of the aircraft but their flights. scripts/bench_probability new-flights has more.
TEST(LandingQuantile, KeepsItsPromiseInNewFlights) {
    const auto kept = test::keep_promises({.flights = 3, .new_flights = 40}, 120, 6999, 3);
    EXPECT_GT(kept.share, 0.93);
    EXPECT_LT(kept.share, 0.97);
    const auto as_if_known = test::keep_promises({.flights = 3, .as_if_known = true, .new_flights = 40}, 120, 6999, 3);
    EXPECT_LT(as_if_known.share, 0.92) << "normal, and the phases independent";
}

TEST(LandingQuantile, IsExactForAProductOfPowerAndDuration) {
    auto mission = steady_mission();
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 15.0;
    mission.uncertainty.duration_sd_s[flight::Phase::cruise] = 150.0;
    // P(left < q) by the integral over the duration: a product of Gaussians is no Gaussian.
    const double q = quantile_of(mission, 0.95);
    double below = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const double z = normal_quantile((i + 0.5) / 4000.0);
        const double lost = 20.0 / 0.36 * (1.0 + 0.15 * z);
        below += 0.5 * std::erfc(((100.0 - q) / lost - 1.0) / 0.15 / std::sqrt(2.0)) / 4000.0;
    }
    EXPECT_NEAR(below, 0.05, 5e-4);  // three times its standard error
}

TEST(LandingQuantile, IsBelowNothingWhereThatManyFail) {
    auto mission = steady_mission();
    mission.initial_soc_percent = 20.0 / 0.36;  // empty in half of the flights
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    EXPECT_LT(quantile_of(mission, 0.95), 0.0);
    const auto quantile = landing_quantile(mission, find_spreads(mission), 0.5);
    EXPECT_NEAR(quantile.left_percent, 0.0, 0.01);
}

TEST(LandingChance, IsThatOfTheQuantile) {
    auto mission = steady_mission();
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 15.0;
    mission.uncertainty.duration_sd_s[flight::Phase::cruise] = 150.0;
    for (const double probability : {0.8, 0.95, 0.99}) {
        mission.reserve_soc_percent = quantile_of(mission, probability);
        const auto chance = landing_chance(mission, find_spreads(mission), probability);
        EXPECT_NEAR(chance.below, 1.0 - probability, 2e-3 * (1.0 - probability));
        EXPECT_NEAR(chance.spare_percent(probability), 0.0, 1e-3 * chance.sd_percent);
        EXPECT_LT(chance.spare_percent(std::min(0.999, probability + 0.05)), 0.0);
    }
}

/// Flights of a pack that is cut off where it is weak or the load high: they fail at once, far above the reserve.
TEST(LandingChance, AgreesWithDrawnFlightsThatAreCutOff) {
    auto mission = steady_mission();
    mission.battery = {"", 10.0, 0.5, 2.0};
    mission.cutoff_voltage_v = 8.78;
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    mission.uncertainty.capacity_sd_percent = 5.0;
    mission.reserve_soc_percent = 30.0;
    const auto chance = landing_chance(mission, find_spreads(mission), 0.95);
    const auto flights = sample_flights(prepare(mission), {}, {20000, 3, 0});
    EXPECT_GT(chance.below, 0.02);
    EXPECT_LT(chance.below, 0.3);
    const double error = std::sqrt(chance.below * (1.0 - chance.below) / 20000.0) + chance.standard_error;
    EXPECT_NEAR(flights.probability_below_reserve, chance.below, 4.0 * error);
}

TEST(LandingQuantile, NeedsNoMarginWhereNothingDiffers) {
    const auto mission = steady_mission();
    const auto quantile = landing_quantile(mission, find_spreads(mission), 0.95);
    EXPECT_EQ(quantile.margin_percent, 0.0);
    EXPECT_EQ(quantile.sd_percent, 0.0);
    EXPECT_NEAR(quantile.left_percent, 100.0 - 20.0 / 0.36, 1e-9);
}

}  // namespace
}  // namespace flightwatt::mission
