#include "mechanical/fit/least_squares.h"

#include <Eigen/QR>

namespace flightwatt::mechanical {

std::optional<LinearFit> solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
    const Eigen::Index columns = matrix.cols();
    if (matrix.rows() < columns) return std::nullopt;
    const Eigen::VectorXd lengths = matrix.colwise().norm();
    if ((lengths.array() <= 0.0).any()) return std::nullopt;

    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix * lengths.cwiseInverse().asDiagonal());
    if (qr.rank() < columns) return std::nullopt;

    const Eigen::MatrixXd inverse_triangle =
        qr.matrixR().topRows(columns).template triangularView<Eigen::Upper>().solve(
            Eigen::MatrixXd::Identity(columns, columns));
    LinearFit fit;
    fit.from_orthonormal = lengths.cwiseInverse().asDiagonal() * (qr.colsPermutation() * inverse_triangle);
    fit.orthonormal = (qr.householderQ().adjoint() * values).head(columns);
    fit.coefficients = qr.solve(values).cwiseQuotient(lengths);
    fit.residual_square_sum = (matrix * fit.coefficients - values).squaredNorm();
    return fit;
}

}  // namespace flightwatt::mechanical
