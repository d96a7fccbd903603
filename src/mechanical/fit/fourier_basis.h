#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The highest order that is supported; beyond it the lowest admissible frequencies leave no digits.
inline constexpr int max_order = 8;

/// How many coefficients a series of that order has: a0, a1, b1, ... a_order, b_order.
constexpr int coefficient_count(int order) { return 2 * order + 1; }

/// One row of the basis of Eq. 1, at angle = theta * tau:
///     1, cos(angle), sin(angle), ... cos(order angle), sin(order angle)
void fourier_row(double angle, int order, std::span<double> row);

/// The rows of all `tau`: samples x coefficient_count(order). theta = omega * duration [rad].
Eigen::MatrixXd fourier_basis(std::span<const double> tau, int order, double theta_rad);

/// Largest over smallest singular value of the basis's columns, each scaled to length 1, on evenly spread
/// samples. It says by how much noise is amplified in the coefficients.
double basis_condition(int order, double theta_rad, std::size_t samples = 1000);

}  // namespace flightwatt::mechanical
