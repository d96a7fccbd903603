#include "mechanical/uncertainty/error_analysis.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/uncertainty/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// A derivative by theta of which less than this part lies outside of the basis shows no frequency.
constexpr double direction_tolerance = 1e-10;

/// What the errors of one flight are made of.
struct FlightPart {
    FlightResiduals residuals;
    Eigen::MatrixXd orthonormal;              ///< Q of the flight's basis
    Eigen::MatrixXd from_orthonormal;         ///< coefficients = this * Q' * power
    Eigen::VectorXd theta_direction;          ///< d curve / d theta, less what coefficients can make up for
    Eigen::VectorXd coefficient_sensitivity;  ///< by how much coefficients rise as theta falls by 1 rad
    double square_sum_about_mean = 0.0;
    double condition = 0.0;
};

PhaseSamples in_order_of_time(const PhaseSamples& samples) {
    std::vector<std::size_t> places(samples.tau.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::ranges::stable_sort(places, {}, [&](std::size_t place) { return samples.tau[place]; });
    PhaseSamples sorted{samples.flight, samples.duration_s, {}, {}};
    for (const auto place : places) {
        sorted.tau.push_back(samples.tau[place]);
        sorted.power_w.push_back(samples.power_w[place]);
    }
    return sorted;
}

/// Residuals for least squares; Huber's pseudo-residuals psi(r) / mean(psi') for robust fits.
Eigen::VectorXd pseudo_residuals(Eigen::VectorXd residual_w, const PhaseFit& fit) {
    if (fit.loss == Loss::none || fit.loss_scale_w <= 0.0) return residual_w;
    double slope = 0.0;
    for (double& residual : residual_w) {
        const double scales = residual / fit.loss_scale_w;
        slope += sample_influence(fit.loss, scales) / static_cast<double>(residual_w.size());
        residual *= sample_weight(fit.loss, scales);
    }
    if (slope <= 0.0) throw NoAnswerError("too many samples are down-weighted to know the fit's errors");
    return residual_w / slope;
}

FlightPart part_of(const PhaseSamples& unsorted, const FlightCurve& curve, const PhaseFit& fit) {
    const auto samples = in_order_of_time(unsorted);
    const ScaledSamples in_watts{samples.tau, samples.power_w, samples.flight};
    const auto at = fourier_residual(in_watts, fit.theta_rad, coefficients_of(curve.fourier));
    const auto qr = solve_least_squares(at.by_coefficients, at.by_theta);
    if (!qr) {
        throw NoAnswerError(
            fmt::format("flight '{}': the samples do not determine the errors of the fit", samples.flight));
    }
    FlightPart part;
    part.residuals.tau = samples.tau;
    part.residuals.step = median_gap(samples.tau);
    part.residuals.residual_w = pseudo_residuals(-at.residual, fit);
    part.from_orthonormal = qr->from_orthonormal;
    part.orthonormal = at.by_coefficients * qr->from_orthonormal;
    part.coefficient_sensitivity = qr->coefficients;
    part.theta_direction = at.by_theta - at.by_coefficients * qr->coefficients;
    if (part.theta_direction.norm() <= direction_tolerance * at.by_theta.norm()) part.theta_direction.setZero();
    const auto power_w = as_vector(samples.power_w);
    part.square_sum_about_mean = (power_w.array() - power_w.mean()).square().sum();
    part.condition = basis_condition(at.by_coefficients);
    return part;
}

/// The flights' parts and what they make together.
struct MeanCurveParts {
    std::vector<FlightPart> parts;
    Eigen::VectorXd coefficients_w;
    Eigen::VectorXd sensitivity;  ///< coefficient_sensitivity of the mean
    double information = 0.0;     ///< of all flights about theta
    double duration_s = 0.0;
};

MeanCurveParts mean_curve_parts(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                std::span<const double> weights) {
    MeanCurveParts mean;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const Eigen::VectorXd own = coefficients_of(fit.flights[i].fourier);
        if (i == 0) mean.coefficients_w = mean.sensitivity = Eigen::VectorXd::Zero(own.size());
        mean.parts.push_back(part_of(flights[i], fit.flights[i], fit));
        mean.coefficients_w += weights[i] * own;
        mean.sensitivity += weights[i] * mean.parts[i].coefficient_sensitivity;
        mean.information += mean.parts[i].theta_direction.squaredNorm();
        mean.duration_s += weights[i] * flights[i].duration_s;
    }
    return mean;
}

double explained_part(const std::vector<FlightPart>& parts, const PhaseFit& fit) {
    double left = 0.0;
    double about_means = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        left += std::pow(fit.flights[i].rms_w, 2) * static_cast<double>(fit.flights[i].samples);
        about_means += parts[i].square_sum_about_mean;
    }
    return about_means > 0.0 ? 1.0 - left / about_means : 1.0;
}

/// The flights' residuals with the directions that coefficients and, unless it is given, theta have used up.
std::vector<FlightResiduals> residuals_of(const MeanCurveParts& mean, bool frequency_is_given) {
    std::vector<FlightResiduals> all;
    for (const auto& part : mean.parts) {
        auto residuals = part.residuals;
        residuals.used_up = part.orthonormal;
        if (!frequency_is_given && part.theta_direction.norm() > 0.0) {
            residuals.used_up.conservativeResize(Eigen::NoChange, part.orthonormal.cols() + 1);
            residuals.used_up.rightCols(1) = part.theta_direction / std::sqrt(mean.information);
        }
        all.push_back(std::move(residuals));
    }
    return all;
}

/// How theta, were it free, follows the noise of flight i; its direction is 0 if the data do not show it.
Eigen::VectorXd theta_response(const MeanCurveParts& mean, std::size_t i) {
    return mean.parts[i].theta_direction / (mean.information > 0.0 ? mean.information : 1.0);
}

/// How theta and the mean's coefficients follow the noise of flight i: samples x (1 + coefficients).
Eigen::MatrixXd response(const MeanCurveParts& mean, std::size_t i, double weight, bool frequency_is_given) {
    const auto& part = mean.parts[i];
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(part.orthonormal.rows(), 1 + part.orthonormal.cols());
    if (!frequency_is_given) rows.col(0) = theta_response(mean, i);
    rows.rightCols(part.orthonormal.cols()) =
        weight * part.orthonormal * part.from_orthonormal.transpose() - rows.col(0) * mean.sensitivity.transpose();
    return rows;
}

/// What one flight's noise adds to the variances.
struct NoiseShare {
    Eigen::MatrixXd covariance;
    double theta_variance = 0.0;
    double degrees_of_freedom = 0.0;
};

NoiseShare share_of(const FlightResiduals& residuals, const Eigen::MatrixXd& rows, const Eigen::VectorXd& theta_rows,
                    double autocorrelation) {
    const auto noise = noise_level(residuals, autocorrelation);
    const auto correlation = sample_correlation(residuals.tau, residuals.step, autocorrelation);
    return {noise.variance_w2 * rows.transpose() * correlated(correlation, rows),
            noise.variance_w2 * theta_rows.dot(correlated(correlation, theta_rows).col(0)), noise.degrees_of_freedom};
}

/// The row of derivatives of the mean curve by theta and the coefficients.
Eigen::RowVectorXd curve_row(const Eigen::VectorXd& coefficients_w, double theta_rad, double tau) {
    const auto at = fourier_residual({{tau}, {0.0}}, theta_rad, coefficients_w);
    Eigen::RowVectorXd row(1 + coefficients_w.size());
    row << at.by_theta(0), at.by_coefficients.row(0);
    return row;
}

/// The mean square over the phase of the curve's standard error, as a matrix to weigh a covariance with.
Eigen::MatrixXd curve_weights(const ErrorAnalysis& analysis) {
    constexpr int points = 200;
    const auto size = 1 + analysis.coefficients_w.size();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < points; ++i) {
        const auto row = curve_row(analysis.coefficients_w, analysis.theta_rad, (i + 0.5) / points);
        sum += row.transpose() * row / points;
    }
    return sum;
}

void fill_standard_errors(ErrorAnalysis& analysis, double duration_s) {
    const Eigen::VectorXd errors = analysis.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    analysis.errors.omega_rad_per_s = errors(0) / duration_s;
    analysis.errors.a0_w = errors(1);
    for (Eigen::Index n = 2; n < errors.size(); n += 2) {
        analysis.errors.cos_w.push_back(errors(n));
        analysis.errors.sin_w.push_back(errors(n + 1));
    }
}

/// Where the autocorrelation stands at its bound, so do the errors. The flights' own coefficients about their mean tell
/// that mean's error too, with all that tells flights apart: where they say less, that is taken.
void take_errors_of_flights(ErrorAnalysis& analysis, const PhaseFit& fit, std::span<const double> weights,
                            const Eigen::MatrixXd& curve) {
    if (std::ranges::count_if(weights, [](double weight) { return weight > 0.0; }) < 2) return;
    const double squares = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(curve.rows(), curve.cols());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const Eigen::VectorXd apart = coefficients_of(fit.flights[i].fourier) - analysis.coefficients_w;
        covariance.bottomRightCorner(apart.size(), apart.size()) +=
            weights[i] * squares / (1.0 - squares) * apart * apart.transpose();
    }
    auto& errors = analysis.errors;
    const double curve_w = std::sqrt(std::max(0.0, curve.cwiseProduct(covariance).sum()));
    const double degrees_of_freedom = std::max(1.0, 1.0 / squares - 1.0);
    if (curve_w * student_t_half_width(degrees_of_freedom) >=
        errors.curve_w * student_t_half_width(errors.degrees_of_freedom)) {
        return;
    }
    analysis.covariance = covariance;
    errors.curve_w = curve_w;
    errors.degrees_of_freedom = degrees_of_freedom;
    errors.frequency_is_given = true;
    errors.from_flights = true;
}

}  // namespace

ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights) {
    ErrorAnalysis analysis;
    auto& errors = analysis.errors;
    const auto mean = mean_curve_parts(flights, fit, weights);
    analysis.theta_rad = fit.theta_rad;
    analysis.coefficients_w = mean.coefficients_w;
    analysis.theta_information = mean.information;
    errors.r2 = explained_part(mean.parts, fit);
    for (const auto& part : mean.parts) errors.condition = std::max(errors.condition, part.condition);
    errors.frequency_is_given = fit.range.at_bound != FrequencyBound::none || mean.information <= 0.0;

    const auto residuals = residuals_of(mean, errors.frequency_is_given);
    errors.autocorrelation = estimate_autocorrelation(residuals);
    for (const auto& flight : residuals) {
        errors.effective_samples +=
            effective_samples(sample_correlation(flight.tau, flight.step, errors.autocorrelation));
    }

    const auto curve = curve_weights(analysis);
    analysis.covariance = Eigen::MatrixXd::Zero(curve.rows(), curve.cols());
    double theta_variance = 0.0;
    double variance_of_variance = 0.0;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
        const Eigen::MatrixXd rows = response(mean, i, weights[i], errors.frequency_is_given);
        const auto share = share_of(residuals[i], rows, theta_response(mean, i), errors.autocorrelation);
        analysis.covariance += share.covariance;
        theta_variance += share.theta_variance;
        const double variance = curve.cwiseProduct(share.covariance).sum();
        variance_of_variance += variance * variance / share.degrees_of_freedom;
    }
    const double curve_variance = std::max(0.0, curve.cwiseProduct(analysis.covariance).sum());
    errors.curve_w = std::sqrt(curve_variance);
    // Satterthwaite's, for variances that add up over the flights.
    errors.degrees_of_freedom = variance_of_variance > 0.0
                                    ? std::max(1.0, curve_variance * curve_variance / variance_of_variance)
                                    : std::max(1.0, errors.effective_samples);
    analysis.free_theta_rad = std::sqrt(std::max(0.0, theta_variance));
    if (errors.autocorrelation >= highest_autocorrelation) take_errors_of_flights(analysis, fit, weights, curve);
    fill_standard_errors(analysis, mean.duration_s);
    return analysis;
}

double curve_standard_error_w(const ErrorAnalysis& analysis, double tau) {
    const auto row = curve_row(analysis.coefficients_w, analysis.theta_rad, tau);
    return std::sqrt(std::max(0.0, (row * analysis.covariance * row.transpose()).value()));
}

}  // namespace flightwatt::mechanical
