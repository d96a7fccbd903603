#include "mechanical/fit/level_law_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// A cruise of constant power at a height, and at an airspeed that goes with it.
PhaseSamples cruise(double power_w, double height_m) {
    PhaseSamples samples{"flight", 600.0, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
    samples.covariates[Covariate::height] = height_m;
    samples.airspeed_cubed_m3_per_s3 = 10.0 * height_m;
    return samples;
}

const std::vector<PhaseSamples> flights{cruise(29.0, 90.0), cruise(30.0, 100.0), cruise(31.0, 110.0)};

TEST(LevelLawFit, IsARidgeLineThatWeighsAsOneMoreFlight) {
    const auto law = fit_level_law(flights, Covariate::height).value();
    EXPECT_EQ(law.flights, 3u);
    EXPECT_DOUBLE_EQ(law.least, 90.0);
    EXPECT_DOUBLE_EQ(law.most, 110.0);
    EXPECT_NEAR(law.slope_w, 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(law.residual_sd_w.value(), std::sqrt(2.0 / 9.0), 1e-12);
    const auto level = level_at(law, 105.0);
    EXPECT_NEAR(level.power_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(level.law_variance, 1.0 / 3.0 + 0.25 / 3.0, 1e-12);
    EXPECT_TRUE(level.within_flights);
}

TEST(LevelLawFit, SaysWhereItReachesBeyondItsFlights) {
    const auto law = fit_level_law(flights, Covariate::height).value();
    const auto beyond = level_at(law, 300.0);
    EXPECT_FALSE(beyond.within_flights);
    EXPECT_DOUBLE_EQ(beyond.power_w, level_at(law, 110.0).power_w);
}

TEST(LevelLawFit, OfCubedAirspeedGoesThroughTheOriginWithARelativeSpread) {
    const auto law = fit_level_law(flights, Covariate::airspeed_cubed).value();
    const double coefficient = (29.0 / 900.0 + 30.0 / 1000.0 + 31.0 / 1100.0) / 3.0;
    const auto near = level_at(law, 1000.0);
    const auto far = level_at(law, 2000.0);
    EXPECT_NEAR(near.power_w, 1000.0 * coefficient, 1e-12);
    EXPECT_NEAR(far.power_w, 2.0 * near.power_w, 1e-12);
    EXPECT_NEAR(far.sd_w.value(), 2.0 * near.sd_w.value(), 1e-12);
    EXPECT_EQ(near.degrees_of_freedom, 2.0);
}

TEST(PowerByCovariate, IsARidgeLineThatWeighsAsOneMoreFlight) {
    // Powers on the line 20 + height / 10; centre 100, standard deviation 10, so z is -1, 0, 1: slope 2 / (2
    // + 1).
    const auto power = power_by_covariate(flights, Covariate::height, 105.0);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    // Residuals -1/3, 0, 1/3, one degree of freedom; z = 0.5 over 3 weights.
    EXPECT_EQ(power->degrees_of_freedom, 1.0);
    EXPECT_NEAR(power->sd_w.value(), std::sqrt(2.0 / 9.0 * (1.0 + 1.0 / 3.0 + 0.25 / 3.0)), 1e-12);
}

TEST(PowerByCovariate, DoesNotReachBeyondWhatTheFlightsShowed) {
    EXPECT_EQ(power_by_covariate(flights, Covariate::height, 500.0)->mean_w,
              power_by_covariate(flights, Covariate::height, 110.0)->mean_w);
}

TEST(PowerByCovariate, HasNoIntervalFromTwoFlights) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    const auto power = power_by_covariate(others, Covariate::height, 100.0);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0, 1e-12);
    EXPECT_FALSE(power->sd_w);
}

TEST(PowerByCovariate, IsUnknownWithoutTheCovariateOrItsSpread) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    EXPECT_FALSE(power_by_covariate(others, Covariate::height, std::nullopt));
    EXPECT_FALSE(power_by_covariate(others, Covariate::wind, 100.0));
    const std::vector<PhaseSamples> same{cruise(29.0, 90.0), cruise(31.0, 90.0)};
    EXPECT_FALSE(power_by_covariate(same, Covariate::height, 90.0));
}

TEST(PowerByCovariate, OfTheAirspeedNeedsTwoFlightsThatMeasuredIt) {
    auto two = std::vector{cruise(20.0, 200.0), cruise(22.0, 220.0)};
    EXPECT_NEAR(power_by_covariate(two, Covariate::airspeed_cubed, 3000.0).value().mean_w, 30.0, 1e-9);
    EXPECT_FALSE(power_by_covariate(two, Covariate::airspeed_cubed, std::nullopt));
    two[1].airspeed_cubed_m3_per_s3.reset();
    EXPECT_FALSE(power_by_covariate(two, Covariate::airspeed_cubed, 3000.0));
}

}  // namespace
}  // namespace flightwatt::mechanical
