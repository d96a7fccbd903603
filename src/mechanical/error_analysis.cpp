#include "mechanical/error_analysis.h"

#include "base/error.h"
#include "mechanical/fourier_basis.h"
#include "mechanical/fourier_residual.h"
#include "mechanical/least_squares.h"
#include "mechanical/median_gap.h"
#include "mechanical/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/SVD>
#include <fmt/format.h>

namespace flightwatt {
namespace {

/// A derivative by theta of which less than this part lies outside of the basis shows no frequency.
constexpr double rounding_level = 1e-10;

/// What the errors of one flight are made of.
struct FlightPart {
    FlightResiduals residuals;
    Eigen::MatrixXd orthonormal;        ///< Q of the flight's basis
    Eigen::MatrixXd from_orthonormal;   ///< coefficients = this * Q' * power
    Eigen::VectorXd theta_direction;    ///< d curve / d theta, less what coefficients can make up for
    Eigen::VectorXd coefficients_turn;  ///< by how much coefficients rise as theta falls by 1 rad
    double square_sum_about_mean = 0.0;
    double condition = 0.0;
};

PhaseSamples in_order_of_time(const PhaseSamples& samples) {
    std::vector<std::size_t> places(samples.tau.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    std::stable_sort(places.begin(), places.end(),
                     [&](std::size_t a, std::size_t b) { return samples.tau[a] < samples.tau[b]; });
    PhaseSamples sorted{samples.flight, samples.duration_s, {}, {}};
    for (const auto place : places) {
        sorted.tau.push_back(samples.tau[place]);
        sorted.power_w.push_back(samples.power_w[place]);
    }
    return sorted;
}

Eigen::VectorXd coefficients_of(const FourierModel& model) {
    Eigen::VectorXd coefficients(coefficient_count(static_cast<int>(model.cos_w.size())));
    coefficients(0) = model.a0_w;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        coefficients(static_cast<Eigen::Index>(2 * n + 1)) = model.cos_w[n];
        coefficients(static_cast<Eigen::Index>(2 * n + 2)) = model.sin_w[n];
    }
    return coefficients;
}

double condition_of(Eigen::MatrixXd basis) {
    basis.colwise().normalize();
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(basis).singularValues();
    return singular(0) / singular(singular.size() - 1);
}

/// Residuals as they push the estimate: those of least squares as they are, those of a robust fit bent.
Eigen::VectorXd pushing(Eigen::VectorXd residual_w, const PhaseFit& fit) {
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
    part.residuals.residual_w = pushing(-at.residual, fit);
    part.from_orthonormal = qr->from_orthonormal;
    part.orthonormal = at.by_coefficients * qr->from_orthonormal;
    part.coefficients_turn = qr->coefficients;
    part.theta_direction = at.by_theta - at.by_coefficients * qr->coefficients;
    if (part.theta_direction.norm() <= rounding_level * at.by_theta.norm()) part.theta_direction.setZero();
    const Eigen::Map<const Eigen::VectorXd> power_w(samples.power_w.data(), at.residual.size());
    part.square_sum_about_mean = (power_w.array() - power_w.mean()).square().sum();
    part.condition = condition_of(at.by_coefficients);
    return part;
}

/// How theta and the mean's coefficients follow the noise of one flight: samples x (1 + coefficients).
Eigen::MatrixXd response(const FlightPart& part, double weight, double information,
                         const Eigen::VectorXd& mean_turn) {
    Eigen::MatrixXd rows(part.orthonormal.rows(), 1 + part.orthonormal.cols());
    rows.col(0).setZero();
    if (information > 0.0) rows.col(0) = part.theta_direction / information;
    rows.rightCols(part.orthonormal.cols()) =
        weight * part.orthonormal * part.from_orthonormal.transpose() - rows.col(0) * mean_turn.transpose();
    return rows;
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

}  // namespace

ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights) {
    ErrorAnalysis analysis;
    auto& errors = analysis.errors;
    analysis.theta_rad = fit.theta_rad;
    std::vector<FlightPart> parts;
    double information = 0.0;
    double residual_square_sum = 0.0;
    double square_sum_about_means = 0.0;
    double duration_s = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        parts.push_back(part_of(flights[i], fit.flights[i], fit));
        information += parts[i].theta_direction.squaredNorm();
        residual_square_sum +=
            std::pow(fit.flights[i].rms_w, 2) * static_cast<double>(fit.flights[i].samples);
        square_sum_about_means += parts[i].square_sum_about_mean;
        errors.condition = std::max(errors.condition, parts[i].condition);
        duration_s += weights[i] * flights[i].duration_s;
        const Eigen::VectorXd own = weights[i] * coefficients_of(fit.flights[i].fourier);
        const Eigen::VectorXd turn = weights[i] * parts[i].coefficients_turn;
        if (i == 0) analysis.coefficients_w = Eigen::VectorXd::Zero(own.size());
        analysis.coefficients_w += own;
    }
    errors.r2 = square_sum_about_means > 0.0 ? 1.0 - residual_square_sum / square_sum_about_means : 1.0;
    errors.frequency_is_given = fit.range.at_bound != "none" || information <= 0.0;

    std::vector<FlightResiduals> residuals;
    Eigen::VectorXd mean_turn = Eigen::VectorXd::Zero(analysis.coefficients_w.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        auto& part = parts[i];
        mean_turn += weights[i] * part.coefficients_turn;
        part.residuals.used_up = part.orthonormal;
        if (!errors.frequency_is_given) {
            part.residuals.used_up.conservativeResize(Eigen::NoChange, part.orthonormal.cols() + 1);
            part.residuals.used_up.rightCols(1) = part.theta_direction / std::sqrt(information);
        }
        residuals.push_back(part.residuals);
    }
    errors.autocorrelation = estimate_autocorrelation(residuals);

    const auto size = 1 + analysis.coefficients_w.size();
    analysis.covariance = Eigen::MatrixXd::Zero(size, size);
    const Eigen::MatrixXd curve = curve_weights(analysis);
    double curve_variance = 0.0;
    double variance_of_variance = 0.0;
    double theta_variance = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& part = parts[i];
        const auto correlation =
            sample_correlation(part.residuals.tau, part.residuals.step, errors.autocorrelation);
        const auto noise = noise_level(part.residuals, errors.autocorrelation);
        const Eigen::MatrixXd rows =
            response(part, weights[i], errors.frequency_is_given ? 0.0 : information, mean_turn);
        const Eigen::MatrixXd covariance =
            noise.variance_w2 * rows.transpose() * correlated(correlation, rows);
        const double share = curve.cwiseProduct(covariance).sum();
        analysis.covariance += covariance;
        curve_variance += share;
        variance_of_variance += share * share / noise.degrees_of_freedom;
        errors.effective_samples += effective_samples(correlation);
        if (information > 0.0) {
            const Eigen::VectorXd direction = part.theta_direction / information;
            theta_variance += noise.variance_w2 * direction.dot(correlated(correlation, direction).col(0));
        }
    }
    errors.curve_w = std::sqrt(std::max(0.0, curve_variance));
    // Satterthwaite's again, for variances that add up over the flights.
    errors.degrees_of_freedom = variance_of_variance > 0.0
                                    ? curve_variance * curve_variance / variance_of_variance
                                    : errors.effective_samples;
    analysis.theta_information = information;
    analysis.free_theta_rad = std::sqrt(std::max(0.0, theta_variance));
    fill_standard_errors(analysis, duration_s);
    return analysis;
}

double curve_standard_error_w(const ErrorAnalysis& analysis, double tau) {
    const auto row = curve_row(analysis.coefficients_w, analysis.theta_rad, tau);
    return std::sqrt(std::max(0.0, (row * analysis.covariance * row.transpose()).value()));
}

}  // namespace flightwatt
