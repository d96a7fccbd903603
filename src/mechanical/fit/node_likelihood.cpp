#include "mechanical/fit/node_likelihood.h"

#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace flightwatt::mechanical {
namespace {

constexpr double min_gap = 0.25;             ///< in median gaps
constexpr double rounding_fraction = 1e-22;  ///< of the values' sum of squares
constexpr double smallest_rounding = 1e-200;

/// The correlation with the sample before.
double decay_of(double gap, double log_autocorrelation) {
    return gap > 0.0 ? std::exp(gap * log_autocorrelation) : 0.0;
}

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

/// What the likelihood is made of.
struct WhitenedFit {
    Eigen::LLT<Eigen::MatrixXd> cholesky;  ///< of the basis's gram matrix
    Eigen::VectorXd shift;                 ///< of the coordinates from those of least squares
    double square_sum = 0.0;
    double degrees_of_freedom = 0.0;
    double log_likelihood = 0.0;
};

WhitenedFit whitened_fit(const FrequencyProjection& flight, double autocorrelation) {
    const Eigen::Index size = flight.columns.cols() - 1;
    double log_determinant = 0.0;
    Eigen::MatrixXd gram;
    if (autocorrelation > 0.0) {
        gram = whitened_gram(flight.columns, flight.gap, autocorrelation, log_determinant);
    } else {
        gram = Eigen::MatrixXd::Identity(size + 1, size + 1);
        gram(size, size) = flight.columns.col(size).squaredNorm();
    }
    WhitenedFit fit;
    fit.cholesky.compute(gram.topLeftCorner(size, size));
    fit.shift = fit.cholesky.solve(gram.col(size).head(size));
    fit.square_sum = std::max(gram(size, size) - fit.shift.dot(gram.col(size).head(size)), flight.rounding);
    fit.degrees_of_freedom = static_cast<double>(flight.columns.rows() - size);
    const double log_of_basis = 2.0 * fit.cholesky.matrixLLT().diagonal().array().log().sum();
    fit.log_likelihood = -0.5 * (log_determinant + log_of_basis + fit.degrees_of_freedom * std::log(fit.square_sum));
    return fit;
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
    const auto fit = whitened_fit(flight, autocorrelation);
    RestrictedLikelihood evidence;
    evidence.coordinates = flight.coordinates + fit.shift;
    evidence.covariance = fit.cholesky.solve(Eigen::MatrixXd::Identity(size, size));
    evidence.square_sum = fit.square_sum;
    evidence.degrees_of_freedom = fit.degrees_of_freedom;
    evidence.log_likelihood = fit.log_likelihood;
    return evidence;
}

double restricted_log_likelihood(const FrequencyProjection& flight, double autocorrelation) {
    return whitened_fit(flight, autocorrelation).log_likelihood;
}

WhitenedSum whitened_sum(std::span<const double> values, const std::vector<double>& gap, double autocorrelation) {
    const double log_r = autocorrelation > 0.0 ? std::log(autocorrelation) : -1e9;
    WhitenedSum sum{values[0] * values[0], 0.0};
    for (std::size_t j = 1; j < values.size(); ++j) {
        const double decay = decay_of(gap[j], log_r);
        const double variance = 1.0 - decay * decay;
        const double fresh = values[j] - decay * values[j - 1];
        sum.square_sum += fresh * fresh / variance;
        sum.log_determinant += std::log(variance);
    }
    return sum;
}

}  // namespace flightwatt::mechanical
