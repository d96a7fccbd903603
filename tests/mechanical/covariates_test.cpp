#include "mechanical/covariates.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// A cruise of constant power at a height.
PhaseSamples cruise(double power_w, std::optional<double> height_m) {
    PhaseSamples samples{"flight", 600.0, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
    samples.covariates[Covariate::height] = height_m;
    return samples;
}

TEST(PowerByCovariate, IsARidgeLineThatWeighsAsOneMoreFlight) {
    // Powers on the line 20 + height / 10; centre 100, standard deviation 10, so z is -1, 0, 1: slope 2 / (2
    // + 1).
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(30.0, 100.0), cruise(31.0, 110.0)};
    const auto power = power_by_covariate(others, cruise(0.0, 105.0), Covariate::height);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0 + 0.5 * 2.0 / 3.0, 1e-12);
    // Residuals -1/3, 0, 1/3, one degree of freedom; z = 0.5 over 3 weights.
    EXPECT_EQ(power->freedom, 1.0);
    EXPECT_NEAR(power->sd_w.value(), std::sqrt(2.0 / 9.0 * (1.0 + 1.0 / 3.0 + 0.25 / 3.0)), 1e-12);
}

TEST(PowerByCovariate, DoesNotReachBeyondWhatTheFlightsShowed) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(30.0, 100.0), cruise(31.0, 110.0)};
    EXPECT_EQ(power_by_covariate(others, cruise(0.0, 500.0), Covariate::height)->mean_w,
              power_by_covariate(others, cruise(0.0, 110.0), Covariate::height)->mean_w);
}

TEST(PowerByCovariate, HasNoIntervalFromTwoFlights) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    const auto power = power_by_covariate(others, cruise(0.0, 100.0), Covariate::height);
    ASSERT_TRUE(power);
    EXPECT_NEAR(power->mean_w, 30.0, 1e-12);
    EXPECT_FALSE(power->sd_w);
}

TEST(PowerByCovariate, IsUnknownWithoutTheCovariateOrItsSpread) {
    const std::vector<PhaseSamples> others{cruise(29.0, 90.0), cruise(31.0, 110.0)};
    EXPECT_FALSE(power_by_covariate(others, cruise(0.0, std::nullopt), Covariate::height));
    EXPECT_FALSE(power_by_covariate(others, cruise(0.0, 100.0), Covariate::wind));
    const std::vector<PhaseSamples> same{cruise(29.0, 90.0), cruise(31.0, 90.0)};
    EXPECT_FALSE(power_by_covariate(same, cruise(0.0, 90.0), Covariate::height));
}

TEST(CovariatesOf, TakesWhatWasKnownBeforeTheCruiseAndEarlyInIt) {
    flight::FlightSeries series;
    for (int i = 0; i < 300; ++i) {
        series.time_s.push_back(i);
        series.voltage_v.push_back(i < 100 ? 12.5 : 11.0);
        series.throttle_percent.push_back(i < 100 ? 0.0 : 70.0);
        series.wind_speed_track.time_s.push_back(i);
        series.wind_speed_track.value.push_back(i <= 130 + 60 ? 3.0 : 9.0);
    }
    flight::Sortie sortie;
    sortie.height_m = 85.0;
    sortie.phases.resize(2);
    sortie.phases[0].phase = flight::Phase::takeoff;
    sortie.phases[0].start.time_s = 100.0;
    sortie.phases[1].phase = flight::Phase::cruise;
    sortie.phases[1].start.time_s = 130.0;
    const auto covariates = covariates_of(series, sortie);
    EXPECT_EQ(covariates[Covariate::height], 85.0);
    EXPECT_EQ(covariates[Covariate::initial_voltage], 12.5);
    EXPECT_EQ(covariates[Covariate::wind], 3.0);
    EXPECT_FALSE(covariates[Covariate::airspeed]);
}

TEST(Covariate, IsFoundByItsName) {
    for (const auto covariate : all_covariates) EXPECT_EQ(covariate_from(to_string(covariate)), covariate);
    EXPECT_FALSE(covariate_from("height"));
}

}  // namespace
}  // namespace flightwatt::mechanical
