#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_samples.h"

#include <span>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// A flight's residuals f(tau) - value and their derivatives, at coefficients a0, a1, b1, a2, b2, ...
struct FourierResidual {
    Eigen::VectorXd residual;         ///< one a sample
    Eigen::VectorXd by_theta;         ///< d residual / d theta
    Eigen::MatrixXd by_coefficients;  ///< d residual / d coefficients: the basis
};

inline FourierResidual fourier_residual(const ScaledSamples& samples, double theta_rad,
                                        const Eigen::VectorXd& coefficients) {
    const int order = static_cast<int>(coefficients.size() - 1) / 2;
    const auto count = static_cast<Eigen::Index>(samples.tau.size());
    const Eigen::Map<const Eigen::VectorXd> tau(samples.tau.data(), count);
    const Eigen::Map<const Eigen::VectorXd> value(samples.value.data(), count);

    FourierResidual result;
    result.by_coefficients = fourier_basis(samples.tau, order, theta_rad);
    result.residual = result.by_coefficients * coefficients - value;
    // d/dtheta of a cos(n theta tau) + b sin(n theta tau) is n tau (b cos - a sin).
    Eigen::VectorXd turned = Eigen::VectorXd::Zero(coefficients.size());
    for (Eigen::Index n = 1; n <= order; ++n) {
        turned(2 * n - 1) = static_cast<double>(n) * coefficients(2 * n);
        turned(2 * n) = -static_cast<double>(n) * coefficients(2 * n - 1);
    }
    result.by_theta = tau.cwiseProduct(result.by_coefficients * turned);
    return result;
}

}  // namespace flightwatt::mechanical
