#pragma once

#include "mechanical/fit/trigonometric_sums.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <optional>
#include <span>

#include <Eigen/Core>

/// The Fourier series of Eq. 1 as linear algebra. Coefficients are in the order a0, a1, b1, a2, b2, ...;
/// theta = omega * duration [rad].
namespace flightwatt::mechanical {

inline Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

Eigen::VectorXd coefficients_of(const FourierModel& model);
FourierModel series_of(const Eigen::VectorXd& coefficients, double omega_rad_per_s);

/// 1, cos(angle), sin(angle), ... sin(order angle) at angle = theta tau: samples x coefficient_count(order).
Eigen::MatrixXd fourier_basis(std::span<const double> tau, int order, double theta_rad);

/// The residuals f(tau) - power of a flight's samples.
Eigen::VectorXd residual_of(const PhaseSamples& samples, double theta_rad, const Eigen::VectorXd& coefficients);

/// A linear least-squares solution.
struct LinearFit {
    Eigen::VectorXd coefficients;
    double residual_square_sum = 0.0;
    Eigen::MatrixXd covariance;  ///< of the coefficients, for values of variance 1
};

/// Minimises |matrix * c - values| by QR with column pivoting (columns scaled to length 1), which loses half
/// the digits that the normal equations lose. std::nullopt if the columns are dependent to rounding.
std::optional<LinearFit> solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);

/// The sum of squares that the best series of that order at theta = stride * step explains. Needs the sums up to
/// m = 2 * order * stride. Directions of the basis within rounding of the normal equations do not count: near-collinear
/// bases explain less.
double explained_square_sum(const TrigonometricSums& sums, std::size_t stride, int order);

/// The flights' common residual sum of squares at one frequency, each flight with its own best coefficients
/// (variable projection); exact sums, normal equations.
double projected_square_sum(std::span<const PhaseSamples> flights, int order, double theta_rad);

}  // namespace flightwatt::mechanical
