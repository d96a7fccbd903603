#include "mechanical/fit/fourier_basis.h"

#include <cmath>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace flightwatt::mechanical {

Eigen::VectorXd coefficients_of(const FourierModel& model) {
    Eigen::VectorXd coefficients(coefficient_count(static_cast<int>(model.cos_w.size())));
    coefficients(0) = model.a0_w;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        coefficients(static_cast<Eigen::Index>(2 * n + 1)) = model.cos_w[n];
        coefficients(static_cast<Eigen::Index>(2 * n + 2)) = model.sin_w[n];
    }
    return coefficients;
}

FourierModel series_of(const Eigen::VectorXd& coefficients, double omega_rad_per_s) {
    FourierModel model{omega_rad_per_s, coefficients(0), {}, {}};
    for (Eigen::Index n = 1; n < coefficients.size(); n += 2) {
        model.cos_w.push_back(coefficients(n));
        model.sin_w.push_back(coefficients(n + 1));
    }
    return model;
}

Eigen::MatrixXd fourier_basis(std::span<const double> tau, int order, double theta_rad) {
    Eigen::MatrixXd basis(static_cast<Eigen::Index>(tau.size()), coefficient_count(order));
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
        const double angle = theta_rad * tau[static_cast<std::size_t>(i)];
        const double c = std::cos(angle);
        const double s = std::sin(angle);
        double cos_n = 1.0;
        double sin_n = 0.0;
        basis(i, 0) = 1.0;
        for (Eigen::Index n = 1; n <= order; ++n) {
            const double next = cos_n * c - sin_n * s;
            sin_n = sin_n * c + cos_n * s;
            cos_n = next;
            basis(i, 2 * n - 1) = cos_n;
            basis(i, 2 * n) = sin_n;
        }
    }
    return basis;
}

double basis_condition(Eigen::MatrixXd basis) {
    basis.colwise().normalize();
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(basis).singularValues();
    return singular(0) / singular(singular.size() - 1);
}

FourierResidual fourier_residual(const ScaledSamples& samples, double theta_rad, const Eigen::VectorXd& coefficients) {
    const int order = static_cast<int>(coefficients.size() - 1) / 2;
    FourierResidual result;
    result.by_coefficients = fourier_basis(samples.tau, order, theta_rad);
    result.residual = result.by_coefficients * coefficients - as_vector(samples.value);
    // d/dtheta of a cos(n theta tau) + b sin(n theta tau) is n tau (b cos - a sin).
    Eigen::VectorXd turned = Eigen::VectorXd::Zero(coefficients.size());
    for (Eigen::Index n = 1; n <= order; ++n) {
        turned(2 * n - 1) = static_cast<double>(n) * coefficients(2 * n);
        turned(2 * n) = -static_cast<double>(n) * coefficients(2 * n - 1);
    }
    result.by_theta = as_vector(samples.tau).cwiseProduct(result.by_coefficients * turned);
    return result;
}

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
