#include "mechanical/fit/error_analysis.h"

#include "base/number.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The weighted mean curve at one frequency.
struct CurveAtFrequency {
    double theta_rad = 0.0;
    Eigen::VectorXd coefficients_w;  ///< a0, a1, b1, ...
    Eigen::MatrixXd covariance_w2;
    double square_sum_w2 = 0.0;
    double reach = 0.0;  ///< half width of its admissible errors, in standard errors
};

/// The mean curve, and the curves at all admissible frequencies.
struct MeanCurve {
    double theta_rad = 0.0;
    Eigen::VectorXd coefficients_w;
    std::vector<CurveAtFrequency> admissible;
    double half_width = 0.0;  ///< of a 95 % interval, in standard errors
};

namespace {

void describe_fit(PhaseErrors& errors, std::span<const PhaseSamples> flights, const PhaseFit& fit) {
    double residual_w2 = 0.0;
    double about_means_w2 = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        residual_w2 += std::pow(fit.flights[i].rms_w, 2) * static_cast<double>(fit.flights[i].samples);
        const auto power_w = as_vector(flights[i].power_w);
        about_means_w2 += (power_w.array() - power_w.mean()).square().sum();
    }
    errors.r2 = about_means_w2 > 0.0 ? 1.0 - residual_w2 / about_means_w2 : 1.0;
    errors.frequency_is_fixed = fit.flights.front().fourier.cos_w.empty() || is_constant(flights);
}

/// The flights with their weights in the mean curve.
struct WeightedFlights {
    std::span<const PhaseSamples> flights;
    std::span<const double> weights;
    double inflation = 1.0;  ///< of variances, because neighbouring samples are correlated
};

/// std::nullopt where the samples do not determine the series.
std::optional<CurveAtFrequency> curve_at(const WeightedFlights& samples, Eigen::Index size, double theta_rad) {
    CurveAtFrequency curve{theta_rad, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
    for (std::size_t i = 0; i < samples.flights.size(); ++i) {
        const auto& flight = samples.flights[i];
        const auto basis = fourier_basis(flight.tau, static_cast<int>(size - 1) / 2, theta_rad);
        const auto fit = solve_least_squares(basis, as_vector(flight.power_w));
        if (!fit) return std::nullopt;
        const double variance_w2 = samples.inflation * fit->residual_square_sum /
                                   static_cast<double>(std::max(basis.rows() - size, Eigen::Index{1}));
        curve.coefficients_w += samples.weights[i] * fit->coefficients;
        curve.covariance_w2 += samples.weights[i] * samples.weights[i] * variance_w2 * fit->covariance;
        curve.square_sum_w2 += fit->residual_square_sum;
    }
    return curve;
}

/// The fitted frequency first, then others between the ends of its own interval, the range's low end, where coefficients
/// are known least, and the rivals. The interval is that of the likelihood: an F test rejects what is beyond.
std::vector<double> frequencies_to_try(const WeightedFlights& samples, const PhaseFit& fit, int order,
                                       double half_width) {
    constexpr int to_each_side = 6;
    constexpr int bisections = 30;
    std::vector<PhaseSamples> centred(samples.flights.begin(), samples.flights.end());
    for (auto& flight : centred) {
        const double mean_w = mean(flight.power_w);
        for (double& power_w : flight.power_w) power_w -= mean_w;
    }
    const auto square_sum = [&](double theta_rad) { return projected_square_sum(centred, order, theta_rad); };
    const double max_sum = square_sum(fit.theta_rad) * (1.0 + half_width * half_width / fit.degrees_of_freedom);
    std::vector<double> tried{fit.theta_rad, fit.range.low_rad};
    for (const double end_rad : {std::max(fit.range.low_rad, fit.theta_rad - scan_grid(fit.range, order).step_rad),
                                 std::min(fit.range.high_rad, fit.theta_rad + scan_grid(fit.range, order).step_rad)}) {
        const double inside_rad = last_true(fit.theta_rad, end_rad, bisections,
                                            [&](double theta_rad) { return square_sum(theta_rad) < max_sum; });
        for (int i = 1; i <= to_each_side; ++i)
            tried.push_back(std::lerp(fit.theta_rad, inside_rad, static_cast<double>(i) / to_each_side));
    }
    tried.insert(tried.end(), fit.rivals_rad.begin(), fit.rivals_rad.end());
    return tried;
}

/// The curves that an F test against the best one does not reject.
std::vector<CurveAtFrequency> admissible_curves(const WeightedFlights& samples, Eigen::Index size, const PhaseFit& fit,
                                                const std::vector<double>& tried, double half_width) {
    std::vector<std::optional<CurveAtFrequency>> curves(tried.size());
    for_each_in_parallel(tried.size(), [&](std::size_t i) { curves[i] = curve_at(samples, size, tried[i]); });
    std::vector<CurveAtFrequency> admissible;
    for (auto& curve : curves) {
        if (!curve) continue;
        const double min_w2 = admissible.empty() ? curve->square_sum_w2 : admissible.front().square_sum_w2;
        const double ratio = min_w2 > 0.0 ? curve->square_sum_w2 / min_w2 : 1.0;
        const double remaining = half_width * half_width - fit.degrees_of_freedom * (ratio - 1.0);
        if (remaining < 0.0) continue;
        curve->reach = std::sqrt(remaining);
        admissible.push_back(*std::move(curve));
    }
    return admissible;
}

/// The standard error of a linear function of the coefficients, row(theta) c, from its widest interval.
template <typename Row>
double standard_error(const MeanCurve& curve, const Row& row) {
    const double found = row(curve.theta_rad).dot(curve.coefficients_w);
    double furthest = 0.0;
    for (const auto& at : curve.admissible) {
        const Eigen::VectorXd factors = row(at.theta_rad);
        const double half = at.reach * std::sqrt(std::max(0.0, factors.dot(at.covariance_w2 * factors)));
        furthest = std::max(furthest, std::abs(factors.dot(at.coefficients_w) - found) + half);
    }
    return furthest / curve.half_width;
}

}  // namespace

ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights) {
    ErrorAnalysis analysis;
    auto& errors = analysis.errors;
    describe_fit(errors, flights, fit);
    errors.autocorrelation = fit.autocorrelation;
    errors.degrees_of_freedom = fit.degrees_of_freedom;
    WeightedFlights samples{flights, weights};
    samples.inflation = (1.0 + fit.autocorrelation) / (1.0 - fit.autocorrelation);
    errors.effective_samples = static_cast<double>(fit.samples) / samples.inflation;
    const auto size = coefficients_of(fit.flights.front().fourier).size();
    MeanCurve curve{fit.theta_rad, Eigen::VectorXd::Zero(size), {}, student_t_half_width(errors.degrees_of_freedom)};
    double duration_s = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        curve.coefficients_w += weights[i] * coefficients_of(fit.flights[i].fourier);
        duration_s += weights[i] * flights[i].duration_s;
    }
    std::vector<double> tried{fit.theta_rad};
    if (!errors.frequency_is_fixed)
        tried = frequencies_to_try(samples, fit, static_cast<int>(size - 1) / 2, curve.half_width);
    curve.admissible = admissible_curves(samples, size, fit, tried, curve.half_width);
    for (Eigen::Index k = 0; k < size; ++k) {
        const double error_w =
            standard_error(curve, [&](double) { return Eigen::VectorXd(Eigen::VectorXd::Unit(size, k)); });
        (k == 0 ? errors.a0_w : k % 2 == 1 ? errors.cos_w.emplace_back() : errors.sin_w.emplace_back()) = error_w;
    }
    double half_width_rad = 0.0;
    for (const auto& at : curve.admissible)
        half_width_rad = std::max(half_width_rad, std::abs(at.theta_rad - curve.theta_rad));
    if (!errors.frequency_is_fixed) errors.omega_rad_per_s = half_width_rad / curve.half_width / duration_s;
    analysis.curve = std::make_shared<const MeanCurve>(std::move(curve));
    constexpr int points = 41;
    double variance_w2 = 0.0;
    for (int i = 0; i < points; ++i)
        variance_w2 += std::pow(curve_standard_error_w(analysis, (i + 0.5) / points), 2) / points;
    errors.curve_w = std::sqrt(variance_w2);
    return analysis;
}

double curve_standard_error_w(const ErrorAnalysis& analysis, double tau) {
    const auto order = static_cast<int>(analysis.curve->coefficients_w.size() - 1) / 2;
    const std::array at{tau};
    return standard_error(*analysis.curve, [&](double theta_rad) -> Eigen::VectorXd {
        return fourier_basis(at, order, theta_rad).row(0).transpose();
    });
}

}  // namespace flightwatt::mechanical
