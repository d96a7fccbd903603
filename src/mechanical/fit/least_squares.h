#pragma once

#include <optional>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// A linear least-squares solution with what follows from it.
struct LinearFit {
    Eigen::VectorXd coefficients;
    double residual_square_sum = 0.0;
    /// The same solution in a basis that is orthonormal on the rows of `matrix`:
    /// coefficients = from_orthonormal * orthonormal.
    Eigen::VectorXd orthonormal;
    Eigen::MatrixXd from_orthonormal;
};

/// Minimises |matrix * c - values| by QR with column pivoting (columns scaled to length 1), which loses half
/// the digits that the normal equations lose. std::nullopt if the columns are dependent to rounding.
std::optional<LinearFit> solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values);

}  // namespace flightwatt::mechanical
