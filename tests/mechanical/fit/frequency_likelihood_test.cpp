#include "mechanical/fit/frequency_likelihood.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(DensityNodes, ResolveAPeakThatOneStartIsOn) {
    for (const double sd : {0.3, 0.01, 1e-5}) {
        const auto density = [&](double x) { return -0.5 * std::pow((x - 5.03) / sd, 2); };
        const auto nodes = refine_density_nodes(density, {3.0, 4.0, 5.0, 5.03, 6.0});
        EXPECT_NEAR(std::exp(log_sum_exp(log_masses(nodes))) / (sd * std::sqrt(2.0 * std::numbers::pi)), 1.0, 0.03)
            << sd;
        EXPECT_LT(nodes.size(), 120U);
    }
}

TEST(RestrictedLikelihood, IsThatOfTheWholeMatrices) {
    std::mt19937 random(1);
    auto samples = test::record(test::published_model().phases[flight::Phase::landing], {60.0, 1.1, 0.5, 0.3}, random);
    const ScaledSamples scaled{samples.tau, samples.power_w, ""};
    constexpr double r = 0.6;
    constexpr double theta_rad = 4.1;
    const auto flight = project_at_frequency(scaled, 3, theta_rad).value();
    const auto evidence = restricted_likelihood(flight, r);
    const auto gaps = normalised_gaps(scaled);
    const auto count = static_cast<Eigen::Index>(gaps.size());
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        double apart = 0.0;
        for (Eigen::Index j = i + 1; j < count; ++j) {
            apart += gaps[static_cast<std::size_t>(j)];
            correlation(i, j) = correlation(j, i) = std::pow(r, apart);
        }
    }
    const auto basis = fourier_basis(samples.tau, 3, theta_rad);
    const Eigen::MatrixXd inverse = correlation.inverse();
    const Eigen::MatrixXd information = basis.transpose() * inverse * basis;
    const auto values = as_vector(samples.power_w);
    const Eigen::VectorXd coefficients = information.inverse() * basis.transpose() * inverse * values;
    const Eigen::VectorXd left = values - basis * coefficients;
    const double square_sum = left.dot(inverse * left);
    EXPECT_NEAR(evidence.square_sum, square_sum, 1e-8 * square_sum);
    EXPECT_LT((flight.from_orthonormal * evidence.coordinates - coefficients).norm(), 1e-6 * coefficients.norm());
    const Eigen::MatrixXd covariance =
        flight.from_orthonormal * evidence.covariance() * flight.from_orthonormal.transpose();
    EXPECT_LT((covariance - information.inverse()).norm(), 1e-6 * covariance.norm());
    const double ratio = information.determinant() / (basis.transpose() * basis).determinant();
    const double freedom = static_cast<double>(count) - 7.0;
    EXPECT_NEAR(evidence.log_likelihood,
                -0.5 * (std::log(correlation.determinant()) + std::log(ratio) + freedom * std::log(square_sum)), 1e-6);
}

}  // namespace
}  // namespace flightwatt::mechanical
