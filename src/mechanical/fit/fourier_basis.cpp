#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace flightwatt::mechanical {
namespace {

/// A pivot below this fraction of its diagonal is rounding: the sums are good to 11 digits.
constexpr double min_pivot = 1e-9;

constexpr int max_columns = coefficient_count(max_order);

/// The inner product of two columns of the basis: column 0 is cos(0), 2n - 1 is cos(n .), 2n is sin(n .).
double inner_product(const TrigonometricSums& sums, std::size_t stride, std::size_t a, std::size_t b) {
    const std::size_t n = (std::max(a, b) + 1) / 2;
    const std::size_t k = (std::min(a, b) + 1) / 2;
    const auto& sum = sums.weight[(n + k) * stride];
    const auto& difference = sums.weight[(n - k) * stride];
    const bool a_is_sine = a > 0 && a % 2 == 0;
    const bool b_is_sine = b > 0 && b % 2 == 0;
    if (a_is_sine && b_is_sine) return (difference.real() - sum.real()) / 2.0;
    if (!a_is_sine && !b_is_sine) return (difference.real() + sum.real()) / 2.0;
    const bool sine_is_higher = (a_is_sine ? a : b) == std::max(a, b);
    return (sum.imag() + (sine_is_higher ? difference.imag() : -difference.imag())) / 2.0;
}

}  // namespace

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

Eigen::VectorXd residual_of(const PhaseSamples& samples, double theta_rad, const Eigen::VectorXd& coefficients) {
    const int order = static_cast<int>(coefficients.size() - 1) / 2;
    return fourier_basis(samples.tau, order, theta_rad) * coefficients - as_vector(samples.power_w);
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
    const Eigen::MatrixXd root = lengths.cwiseInverse().asDiagonal() * (qr.colsPermutation() * inverse_triangle);
    fit.covariance = root * root.transpose();
    fit.coefficients = qr.solve(values).cwiseQuotient(lengths);
    fit.residual_square_sum = (matrix * fit.coefficients - values).squaredNorm();
    return fit;
}

double explained_square_sum(const TrigonometricSums& sums, std::size_t stride, int order) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_columns, max_columns>;
    using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_columns, 1>;
    const Eigen::Index columns = coefficient_count(order);
    Matrix gram(columns, columns);
    Vector right(columns);
    for (Eigen::Index row = 0; row < columns; ++row) {
        const auto& value = sums.value[static_cast<std::size_t>(row + 1) / 2 * stride];
        right(row) = row > 0 && row % 2 == 0 ? value.imag() : value.real();
        for (Eigen::Index column = 0; column <= row; ++column)
            gram(row, column) = gram(column, row) =
                inner_product(sums, stride, static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }
    // With columns of length 1: the sum explained is that of z_j^2 / d_j with L z = P right.
    const Vector scale = gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    const Eigen::LDLT<Matrix> factor(scale.asDiagonal() * gram * scale.asDiagonal());
    Vector z = factor.transpositionsP() * scale.cwiseProduct(right);
    factor.matrixL().solveInPlace(z);
    const auto pivots = factor.vectorD().array();
    return (pivots > min_pivot).select(z.array().square() / pivots, 0.0).sum();
}

double projected_square_sum(std::span<const PhaseSamples> flights, int order, double theta_rad) {
    double sum = 0.0;
    for (const auto& flight : flights) {
        const auto sums = trigonometric_sums(flight, theta_rad, 2 * static_cast<std::size_t>(order) + 1);
        const double total = as_vector(flight.power_w).squaredNorm();
        sum += std::max(0.0, total - explained_square_sum(sums, 1, order));
    }
    return sum;
}

}  // namespace flightwatt::mechanical
