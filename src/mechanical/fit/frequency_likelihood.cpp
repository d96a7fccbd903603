#include "mechanical/fit/frequency_likelihood.h"

#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flightwatt::mechanical {
namespace {

constexpr double min_gap = 0.25;             ///< in median gaps
constexpr double rounding_fraction = 1e-22;  ///< of the values' sum of squares
constexpr double smallest_rounding = 1e-200;

/// Gram matrix of the rows after R^-1/2, which takes from each sample what the one before told.
Eigen::MatrixXd whitened_gram(const Eigen::MatrixXd& rows, const std::vector<double>& gap, double autocorrelation,
                              double& log_determinant) {
    const Eigen::Index later = rows.rows() - 1;
    const Eigen::ArrayXd decay = (as_vector(gap).tail(later).array() * std::log(autocorrelation)).exp();
    const Eigen::ArrayXd variance = 1.0 - decay.square();
    log_determinant = variance.log().sum();
    const Eigen::VectorXd fresh_part = variance.rsqrt();
    const Eigen::VectorXd told_part = decay * fresh_part.array();
    Eigen::MatrixXd white(rows.rows(), rows.cols());
    white.row(0) = rows.row(0);
    white.bottomRows(later) = fresh_part.asDiagonal() * rows.bottomRows(later);
    white.bottomRows(later) -= told_part.asDiagonal() * rows.topRows(later);
    return white.transpose() * white;
}

}  // namespace

std::vector<double> normalised_gaps(const ScaledSamples& samples) {
    const double step = median_gap(samples.tau);
    std::vector<double> gaps(samples.tau.size(), 0.0);
    for (std::size_t j = 1; j < gaps.size(); ++j) {
        gaps[j] = std::max(min_gap, step > 0.0 ? (samples.tau[j] - samples.tau[j - 1]) / step : 0.0);
    }
    return gaps;
}

std::optional<FrequencyProjection> project_at_frequency(const ScaledSamples& samples, int order, double theta_rad) {
    const auto basis = fourier_basis(samples.tau, order, theta_rad);
    auto fit = solve_least_squares(basis, as_vector(samples.value));
    if (!fit) return std::nullopt;
    FrequencyProjection flight;
    flight.columns.resize(basis.rows(), basis.cols() + 1);
    flight.columns.leftCols(basis.cols()) = basis * fit->from_orthonormal;
    flight.columns.rightCols(1) = as_vector(samples.value) - basis * fit->coefficients;
    flight.from_orthonormal = std::move(fit->from_orthonormal);
    flight.coordinates = std::move(fit->orthonormal);
    flight.gap = normalised_gaps(samples);
    flight.rounding = std::max(rounding_fraction * as_vector(samples.value).squaredNorm(), smallest_rounding);
    return flight;
}

RestrictedLikelihood restricted_likelihood(const FrequencyProjection& flight, double autocorrelation) {
    const Eigen::Index size = flight.columns.cols() - 1;
    double log_determinant = 0.0;
    Eigen::MatrixXd gram;
    if (autocorrelation > 0.0) {
        gram = whitened_gram(flight.columns, flight.gap, autocorrelation, log_determinant);
    } else {
        gram = Eigen::MatrixXd::Identity(size + 1, size + 1);
        gram(size, size) = flight.columns.col(size).squaredNorm();
    }
    RestrictedLikelihood fit;
    fit.cholesky.compute(gram.topLeftCorner(size, size));
    const Eigen::VectorXd shift = fit.cholesky.solve(gram.col(size).head(size));
    fit.coordinates = flight.coordinates + shift;
    fit.square_sum = std::max(gram(size, size) - shift.dot(gram.col(size).head(size)), flight.rounding);
    fit.degrees_of_freedom = static_cast<double>(flight.columns.rows() - size);
    const double log_of_basis = 2.0 * fit.cholesky.matrixLLT().diagonal().array().log().sum();
    fit.log_likelihood = -0.5 * (log_determinant + log_of_basis + fit.degrees_of_freedom * std::log(fit.square_sum));
    return fit;
}

}  // namespace flightwatt::mechanical
