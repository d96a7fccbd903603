#include "mechanical/fit/flight_variation.h"

#include "helpers/made_up_flights.h"
#include "mechanical/prediction.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// The same by summing the covariance over all pairs of moments.
double summed_covariance(const DriftProcess& drift, double from_a, double to_a, double from_b, double to_b) {
    constexpr int points = 2000;
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
            const double a = from_a + (to_a - from_a) * (i + 0.5) / points;
            const double b = from_b + (to_b - from_b) * (j + 0.5) / points;
            sum += std::exp(-std::abs(a - b) / drift.correlation_s);
        }
    }
    return drift.sd_w * drift.sd_w * sum / points / points;
}

TEST(Drift, AgreesWithTheSumOverAllPairs) {
    const DriftProcess drift{3.0, 40.0};
    EXPECT_NEAR(variance_of_mean_w2(drift, 100.0), summed_covariance(drift, 0, 100, 0, 100), 1e-4);
    EXPECT_NEAR(covariance_of_means_w2(drift, 30.0, 100.0), summed_covariance(drift, 0, 30, 30, 130), 1e-4);
}

TEST(Drift, HasItsLimits) {
    const DriftProcess drift{3.0, 40.0};
    EXPECT_NEAR(variance_of_mean_w2(drift, 1e-9), 9.0, 1e-9);
    EXPECT_NEAR(variance_of_mean_w2(drift, 0.00399), variance_of_mean_w2(drift, 0.00401), 2e-6);
    EXPECT_NEAR(variance_of_mean_w2(drift, 4e6) * 4e6, 9.0 * 2.0 * 40.0, 0.1);
    EXPECT_NEAR(covariance_of_means_w2(drift, 1e-12, 1e-12), 9.0, 1e-9);
}

/// Var of the whole mean is made of the parts' variances and their covariance.
TEST(Drift, IsOneProcessOverBothStretches) {
    const DriftProcess drift{2.0, 70.0};
    const double u = 300.0;
    const double r = 500.0;
    const double whole = (u * u * variance_of_mean_w2(drift, u) + r * r * variance_of_mean_w2(drift, r) +
                          2.0 * u * r * covariance_of_means_w2(drift, u, r)) /
                         ((u + r) * (u + r));
    EXPECT_NEAR(variance_of_mean_w2(drift, u + r), whole, 1e-12);
}

using test::cruise_of;
using test::record;

PhaseSamples constant(double power_w, double duration_s) {
    PhaseSamples samples{"constant", duration_s, {}, {}};
    for (int i = 0; i < 200; ++i) {
        samples.tau.push_back((i + 0.5) / 200.0);
        samples.power_w.push_back(power_w);
    }
    return samples;
}

TEST(VarianceComponents, NeedsTwoFlights) {
    const std::vector flights{constant(20.0, 600.0)};
    EXPECT_FALSE(estimate_variance_components(cruise_of(1.0, {1.0}, {0.0}), flights).has_value());
}

TEST(VarianceComponents, OfConstantFlightsAboutAConstantIsTheirLevelsAlone) {
    const std::vector flights{constant(20.0, 600.0), constant(22.0, 600.0), constant(27.0, 700.0)};
    const auto spread = estimate_variance_components(cruise_of(1.0, {0.0}, {0.0}), flights).value();
    EXPECT_EQ(spread.flights, 3u);
    EXPECT_NEAR(spread.between_flight_sd_w, std::sqrt(13.0), 1e-9);
    EXPECT_NEAR(spread.drift_sd_w, 0.0, 1e-6);
}

/// A drift that was made with known variance and correlation is found again.
TEST(VarianceComponents, FindsTheDriftThatWasMade) {
    const auto phase = cruise_of(1.0, {2.0}, {-1.0});
    constexpr double interval_s = 1.0;
    constexpr double sd_w = 4.0;
    constexpr double correlation_s = 60.0;
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<PhaseSamples> flights;
    for (int f = 0; f < 20; ++f) {
        auto flight = record(phase, {1500.0, interval_s, 0.0, 0.0}, random);
        const double kept = std::exp(-interval_s / correlation_s);
        double drift_w = sd_w * normal(random);
        for (double& power : flight.power_w) {
            drift_w = kept * drift_w + std::sqrt(1.0 - kept * kept) * sd_w * normal(random);
            power += drift_w;
        }
        flights.push_back(std::move(flight));
    }
    const auto spread = estimate_variance_components(phase, flights).value();
    // The larger of two estimates: not less than was made, and by halves known to a sixth.
    EXPECT_GT(spread.drift_sd_w, 0.9 * sd_w);
    EXPECT_LT(spread.drift_sd_w, 1.4 * sd_w);
    EXPECT_NEAR(spread.correlation_s, correlation_s, 0.25 * correlation_s);
}

PhaseSamples three_samples(double power_w, double duration_s) {
    return {"constant", duration_s, {0.0, 0.5, 1.0}, {power_w, power_w, power_w}};
}

TEST(Baselines, ConstantMeanIsThatOfTheFlights) {
    const std::vector flights{three_samples(20.0, 600.0), three_samples(22.0, 60.0), three_samples(27.0, 900.0)};
    const auto power = constant_mean(flights);
    EXPECT_DOUBLE_EQ(power.mean_w, 23.0);
    EXPECT_NEAR(power.sd_w.value(), std::sqrt(13.0 * 4.0 / 3.0), 1e-12);
    EXPECT_DOUBLE_EQ(power.degrees_of_freedom, 2.0);
    EXPECT_NEAR(energy_of(power, 360.0).energy_wh, 2.3, 1e-12);
    EXPECT_NEAR(energy_of(power, 360.0).variance_wh2, 0.01 * 13.0 * 4.0 / 3.0, 1e-12);
}

TEST(Baselines, OneFlightHasNoInterval) {
    const std::vector flights{three_samples(20.0, 600.0)};
    EXPECT_FALSE(interval_95(energy_of(constant_mean(flights), 100.0)).has_value());
}

}  // namespace
}  // namespace flightwatt::mechanical
