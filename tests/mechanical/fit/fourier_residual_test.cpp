#include "mechanical/fit/fourier_residual.h"

#include "helpers/made_up_flights.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

Eigen::VectorXd some_coefficients(int order) {
    Eigen::VectorXd coefficients(coefficient_count(order));
    for (Eigen::Index j = 0; j < coefficients.size(); ++j)
        coefficients(j) = (j % 2 == 0 ? 1.0 : -0.7) * (1.0 + 0.3 * static_cast<double>(j));
    return coefficients;
}

TEST(FourierResidual, IsCurveMinusSamples) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    std::mt19937 random(1);
    const auto samples = test::record(phase, {28.0, 1.1, 0.0, 0.0}, random);
    const auto& f = phase.fourier;
    Eigen::VectorXd coefficients(7);
    coefficients << f.a0_w, f.cos_w[0], f.sin_w[0], f.cos_w[1], f.sin_w[1], f.cos_w[2], f.sin_w[2];
    const auto result =
        fourier_residual({samples.tau, samples.power_w}, test::theta_rad(phase), coefficients);
    EXPECT_LT(result.residual.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(FourierResidual, DerivativesAreThoseOfDifferences) {
    const auto samples = test::centred(test::record_flights(flight::Phase::cruise, 1, 1.0, 3).front());
    constexpr double step = 1e-6;
    for (const int order : {1, 3, 5}) {
        for (const double theta_rad : {3.2, 8.0, 60.0}) {
            const auto coefficients = some_coefficients(order);
            const auto at = fourier_residual(samples, theta_rad, coefficients);
            const Eigen::VectorXd difference_by_theta =
                (fourier_residual(samples, theta_rad + step, coefficients).residual -
                 fourier_residual(samples, theta_rad - step, coefficients).residual) /
                (2.0 * step);
            EXPECT_LT((at.by_theta - difference_by_theta).cwiseAbs().maxCoeff(), 1e-6);
            for (Eigen::Index j = 0; j < coefficients.size(); ++j) {
                auto shifted = coefficients;
                shifted(j) += step;
                const Eigen::VectorXd up = fourier_residual(samples, theta_rad, shifted).residual;
                const Eigen::VectorXd difference = (up - at.residual) / step;
                EXPECT_LT((at.by_coefficients.col(j) - difference).cwiseAbs().maxCoeff(), 1e-6)
                    << "column " << j;
            }
        }
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
