#include "mechanical/uncertainty/residual_correlation.h"

#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

const std::vector<double> with_gaps{0.0, 0.1, 0.2, 0.5, 0.55, 0.9, 1.0};

/// The correlation matrix, entry by entry.
Eigen::MatrixXd full_matrix(const std::vector<double>& tau, double step, double autocorrelation) {
    const auto count = static_cast<Eigen::Index>(tau.size());
    Eigen::MatrixXd matrix(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j < count; ++j) {
            const double gap = std::abs(tau[static_cast<std::size_t>(i)] - tau[static_cast<std::size_t>(j)]);
            matrix(i, j) = std::pow(autocorrelation, gap / step);
        }
    }
    return matrix;
}

/// Evenly spread noise of that autocorrelation; the fit of a third-order series taken out.
FlightResiduals residuals_of_noise(int samples, double autocorrelation, double noise_w, std::mt19937& random) {
    std::normal_distribution<double> normal(0.0, noise_w);
    FlightResiduals flight;
    flight.step = 1.0 / samples;
    Eigen::VectorXd noise(samples);
    double state = normal(random);
    for (int i = 0; i < samples; ++i) {
        flight.tau.push_back((i + 0.5) / samples);
        noise(i) = state;
        state = autocorrelation * state + std::sqrt(1.0 - autocorrelation * autocorrelation) * normal(random);
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fourier_basis(flight.tau, 3, 6.0));
    flight.used_up = qr.householderQ() * Eigen::MatrixXd::Identity(samples, 7);
    flight.residual_w = noise - flight.used_up * (flight.used_up.transpose() * noise);
    return flight;
}

TEST(ResidualCorrelation, TwoPassesAreTheWholeMatrix) {
    const auto correlation = sample_correlation(with_gaps, 0.1, 0.6);
    const auto matrix = full_matrix(with_gaps, 0.1, 0.6);
    const Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(7, 7);
    EXPECT_LT((correlated(correlation, rows) - matrix).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_NEAR(effective_samples(correlation), 49.0 / matrix.sum(), 1e-12);
}

TEST(ResidualCorrelation, EffectiveSamplesAreThoseOfTheTextbookWithoutGaps) {
    std::vector<double> tau;
    for (int i = 0; i < 20000; ++i) tau.push_back(i / 20000.0);
    EXPECT_NEAR(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.5)), 20000.0 / 3.0, 2.0);
    EXPECT_DOUBLE_EQ(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.0)), 20000.0);
}

TEST(ResidualCorrelation, IndependentSamplesMakeTheUsualVarianceAndDegreesOfFreedom) {
    std::mt19937 random(1);
    const auto flight = residuals_of_noise(60, 0.0, 0.3, random);
    const auto noise = noise_level(flight, 0.0);
    EXPECT_NEAR(noise.degrees_of_freedom, 53.0, 1e-9);
    EXPECT_NEAR(noise.variance_w2, flight.residual_w.squaredNorm() / 53.0, 1e-12);
}

TEST(ResidualCorrelation, FindsTheAutocorrelationAndTheVarianceOfLongFlights) {
    for (const double truth : {0.0, 0.3, 0.8}) {
        double autocorrelation = 0.0;
        double variance_w2 = 0.0;
        constexpr int times = 20;
        std::mt19937 random(3);
        for (int i = 0; i < times; ++i) {
            const std::vector flights{residuals_of_noise(600, truth, 0.5, random)};
            autocorrelation += estimate_autocorrelation(flights) / times;
            variance_w2 += noise_level(flights[0], truth).variance_w2 / times;
        }
        EXPECT_NEAR(autocorrelation, truth, 0.03) << truth;
        EXPECT_NEAR(variance_w2, 0.25, 0.02) << truth;
    }
}

TEST(ResidualCorrelation, ExactSamplesHaveNone) {
    std::mt19937 random(1);
    auto flight = residuals_of_noise(60, 0.5, 0.3, random);
    flight.residual_w.setZero();
    EXPECT_EQ(estimate_autocorrelation(std::vector{flight}), 0.0);
    EXPECT_EQ(noise_level(flight, 0.0).variance_w2, 0.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
