#include "mission/sampling/landing_quantile.h"

#include "base/statistics.h"
#include "mission/sampled_flights.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// 20 W over 1000 s from 36 kJ: 55.6 points are lost.
Mission steady() {
    Mission mission;
    mission.name = "steady";
    mission.duration_s[flight::Phase::cruise] = 1000.0;
    mission.battery = {"", 10.0, 0.0, 1.0};
    mission.schedule = {{flight::Phase::cruise, 0.0, 1000.0, {}}};
    mission.mechanical = mechanical::MechanicalModel();
    mission.mechanical->phases[flight::Phase::cruise].fourier = {0.01, 20.0, {}, {}};
    mission.mechanical->phases[flight::Phase::cruise].duration_s = 1000.0;
    return mission;
}

double quantile_of(const Mission& mission, double probability) {
    return landing_quantile(mission, find_spreads(mission), probability).left_percent;
}

TEST(LandingQuantile, IsThatOfAGaussianWhereDepletionIsLinear) {
    auto mission = steady();
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    for (const double probability : {0.5, 0.8, 0.95, 0.999})
        EXPECT_NEAR(quantile_of(mission, probability),
                    100.0 - 20.0 / 0.36 * (1.0 + 0.05 * normal_quantile(probability)), 2e-3);
    EXPECT_THROW(quantile_of(mission, 0.4), std::invalid_argument);
    EXPECT_THROW(quantile_of(mission, 1.0), std::invalid_argument);
}

TEST(LandingQuantile, IsExactForAProductOfPowerAndDuration) {
    auto mission = steady();
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
    EXPECT_NEAR(below, 0.05, 2e-4);
}

TEST(LandingQuantile, IsBelowNothingWhereThatManyFail) {
    auto mission = steady();
    mission.initial_soc_percent = 20.0 / 0.36;  // empty in half of the flights
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    EXPECT_LT(quantile_of(mission, 0.95), 0.0);
    const auto quantile = landing_quantile(mission, find_spreads(mission), 0.5);
    EXPECT_NEAR(quantile.left_percent, 0.0, 0.01);
}

TEST(LandingQuantile, NeedsNoMarginWhereNothingDiffers) {
    const auto mission = steady();
    const auto quantile = landing_quantile(mission, find_spreads(mission), 0.95);
    EXPECT_EQ(quantile.margin_percent, 0.0);
    EXPECT_EQ(quantile.sd_percent, 0.0);
    EXPECT_NEAR(quantile.left_percent, 100.0 - 20.0 / 0.36, 1e-9);
}

}  // namespace
}  // namespace flightwatt::mission
