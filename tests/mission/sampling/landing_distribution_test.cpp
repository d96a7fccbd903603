#include "mission/sampling/landing_distribution.h"

#include "base/statistics.h"
#include "helpers/generated_missions.h"
#include "helpers/new_flights.h"
#include "helpers/steady_mission.h"
#include "mission/sampled_flights.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::steady_mission;

double quantile_of(const Mission& mission, double probability) {
    return draw_landings(mission, collect_uncertainty(mission.setup)).quantile_percent(probability);
}

/// Of a probability, as so many flights are drawn.
double standard_error(double probability) {
    return std::sqrt(probability * (1.0 - probability) / static_cast<double>(landing_flights));
}

TEST(LandingDistribution, IsThatOfAGaussianWhereDepletionIsLinear) {
    auto mission = steady_mission();
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    for (const double probability : {0.5, 0.8, 0.95, 0.999}) {
        const double deviations = (quantile_of(mission, probability) - (100.0 - 20.0 / 0.36)) / (-0.05 * 20.0 / 0.36);
        const double kept = 0.5 * std::erfc(-deviations / std::sqrt(2.0));
        EXPECT_NEAR(kept, probability, 4.0 * standard_error(probability));
    }
}

TEST(LandingDistribution, IsThatOfStudentTWhereFewFlightsShowTheLevel) {
    auto mission = steady_mission();
    auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    mission.setup.battery.capacity_ah = 10.0;
    cruise.flights = 3;
    cruise.level_spread = mechanical::VarianceComponents{3, 1.0, 0.0, 1.0};
    const double sd_w = std::sqrt(1.0 + 1.0 / 3.0);
    for (const double probability : {0.5, 0.8, 0.95, 0.999}) {
        const double level_w = 3.6 * (100.0 - quantile_of(mission, probability));
        const double t = (level_w - 20.0) / sd_w;  // with two degrees of freedom P(T < t) = 1/2 + t / 2 sqrt(2 + t^2)
        EXPECT_NEAR(0.5 + t / (2.0 * std::sqrt(2.0 + t * t)), probability, 4.0 * standard_error(probability));
    }
}

TEST(LandingDistribution, RefusesProbabilitiesThatAreNone) {
    const auto mission = steady_mission();
    for (const double probability : {0.4, 1.0}) {
        EXPECT_THROW(draw_landings_until_known(mission, collect_uncertainty(mission.setup), probability),
                     std::invalid_argument);
    }
}

/// The models know nothing of the aircraft but their flights. studies/probability new-flights has more.
TEST(LandingDistribution, KeepsItsPromiseInNewFlights) {
    const auto kept = test::keep_promises({.flights = 3, .new_flights = 40}, 120, 6999, 3);
    EXPECT_GT(kept.share, 0.93);
    EXPECT_LT(kept.share, 0.97);
    const auto as_if_known = test::keep_promises({.flights = 3, .as_if_known = true, .new_flights = 40}, 120, 6999, 3);
    EXPECT_LT(as_if_known.share, 0.92) << "normal, and the phases independent";
}

TEST(LandingDistribution, IsExactForAProductOfPowerAndDuration) {
    auto mission = steady_mission();
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 15.0;
    mission.setup.uncertainty.duration_sd_s[flight::Phase::cruise] = 150.0;
    // P(left < q) by the integral over the duration: a product of Gaussians is no Gaussian.
    const double q = quantile_of(mission, 0.95);
    double below = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const double z = normal_quantile((i + 0.5) / 4000.0);
        const double lost = 20.0 / 0.36 * (1.0 + 0.15 * z);
        below += 0.5 * std::erfc(((100.0 - q) / lost - 1.0) / 0.15 / std::sqrt(2.0)) / 4000.0;
    }
    EXPECT_NEAR(below, 0.05, 4.0 * standard_error(0.95));
}

TEST(LandingDistribution, IsBelowNothingWhereThatManyFail) {
    auto mission = steady_mission();
    mission.setup.initial_soc_percent = 20.0 / 0.36;  // empty in half of the flights
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    EXPECT_LT(quantile_of(mission, 0.95), 0.0);
    EXPECT_NEAR(quantile_of(mission, 0.5), 0.0, 0.1);
}

TEST(LandingDistribution, HasTheProbabilityOfItsQuantile) {
    auto mission = steady_mission();
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 15.0;
    mission.setup.uncertainty.duration_sd_s[flight::Phase::cruise] = 150.0;
    for (const double probability : {0.8, 0.95, 0.99}) {
        mission.setup.reserve_soc_percent = quantile_of(mission, probability);
        const auto landings = draw_landings_until_known(mission, collect_uncertainty(mission.setup), probability);
        EXPECT_EQ(landings.left_percent.size(), landing_flights) << "none fewer show it";
        EXPECT_NEAR(landings.below(), 1.0 - probability, 1.0 / static_cast<double>(landing_flights));
        EXPECT_EQ(landings.spare_percent(probability), 0.0);
        EXPECT_LT(landings.spare_percent(std::min(0.999, probability + 0.05)), 0.0);
        mission.setup.reserve_soc_percent -= 2.0 * landings.sd_percent;
        EXPECT_LT(
            draw_landings_until_known(mission, collect_uncertainty(mission.setup), probability).left_percent.size(),
            landing_flights)
            << "far from the reserve fewer do";
    }
}

/// Flights of a pack that is cut off where it is weak or the load high: they fail at once, far above the reserve.
TEST(LandingDistribution, AgreesWithDrawnFlightsThatAreCutOff) {
    auto mission = steady_mission();
    mission.setup.battery = {"", 10.0, 0.5, 2.0};
    mission.setup.cutoff_voltage_v = 8.78;
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    mission.setup.uncertainty.capacity_sd_percent = 5.0;
    mission.setup.reserve_soc_percent = 30.0;
    const auto landings = draw_landings(mission, collect_uncertainty(mission.setup));
    const auto flights = sample_flights(prepare_mission(mission), {}, {20000, 3, 0});
    EXPECT_GT(landings.below(), 0.02);
    EXPECT_LT(landings.below(), 0.3);
    EXPECT_NEAR(flights.probability_below_reserve, landings.below(), 4.0 * std::sqrt(2.0) * landings.standard_error());
}

/// A mission of few known flights, with a pack so weak that `failing` of its flights are cut off at once in take-off,
/// and with much to spare in all others.
Mission weak_in_takeoff(unsigned seed, double failing) {
    auto mission = with_minimum_energy_schedule(test::generated_mission(seed).problem);
    auto& battery = mission.setup.battery;
    battery.capacity_ah *= 3.0;
    battery.resistance_ohm = 0.08;
    mission.setup.reserve_soc_percent = 10.0;
    mission.setup.mechanical->flights.resize(3);
    for (const auto phase : flight::all_phases) {
        auto& part = mission.setup.mechanical->phases[phase];
        part.flights = 3;
        const double spread_w = (phase == flight::Phase::takeoff ? 0.25 : 0.05) * part.fourier.a0_w;
        part.level_spread = mechanical::VarianceComponents{3, spread_w, 0.1, 20.0};
        for (std::size_t k = 0; k < 3; ++k)
            mission.setup.mechanical->flights[k].phases[phase] = mechanical::PhaseContribution{
                1.0 / 3.0, part.duration_s * (0.9 + 0.1 * static_cast<double>(k)), 1.0, 100};
    }
    mission.setup.uncertainty.level_sd_percent = {};
    const auto too_few_fail = [&](double cutoff_voltage_v) {
        mission.setup.cutoff_voltage_v = cutoff_voltage_v;
        return sample_flights(prepare_mission(mission), {}, {2000, 5, 0}).probability_battery_failure < failing;
    };
    double low_v = 6.0;
    double high_v = 12.5;
    while (high_v - low_v > 0.02)
        (too_few_fail(std::midpoint(low_v, high_v)) ? low_v : high_v) = std::midpoint(low_v, high_v);
    mission.setup.cutoff_voltage_v = low_v;
    return mission;
}

/// Levels of three flights are Student t with two degrees of freedom: far out in one way, a flight is far out in others
/// too.
TEST(LandingDistributionStudy, AgreesWithDrawnFlightsOfWeakPacks) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const double failing = seed % 3 == 0 ? 0.1 : seed % 3 == 1 ? 0.02 : 0.04;
        const auto mission = weak_in_takeoff(seed, failing);
        for (const double part : {1.0, 0.01}) {
            auto flown = mission;
            flown.setup.duration_s[flight::Phase::cruise] *= part;
            flown.schedule =
                rescale_to_flown_durations(mission.schedule, mission.setup.duration_s, flown.setup.duration_s);
            const auto landings = draw_landings_until_known(flown, collect_uncertainty(flown.setup), 0.95);
            const auto flights = sample_flights(prepare_mission(flown), {}, {20000, 3, 0});
            EXPECT_NEAR(flights.probability_below_reserve, landings.below(),
                        4.0 * std::sqrt(2.0) * landings.standard_error())
                << "seed " << seed << ", cruise times " << part;
        }
    }
}

TEST(LandingDistribution, NeedsNoMarginWhereNothingDiffers) {
    const auto mission = steady_mission();
    const auto landings = draw_landings(mission, collect_uncertainty(mission.setup));
    EXPECT_EQ(landings.left_percent.size(), 1U);
    EXPECT_EQ(landings.sd_percent, 0.0);
    EXPECT_EQ(landings.standard_error(), 0.0);
    EXPECT_NEAR(landings.quantile_percent(0.95), 100.0 - 20.0 / 0.36, 1e-9);
}

}  // namespace
}  // namespace flightwatt::mission
