#include "mechanical/fit/error_analysis.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace flightwatt::mechanical {
namespace {

/// So much weight keeps frequencies below one period, and below three quarters of one, in the intervals of
/// coefficients. Chosen with simulations of Table I in view.
constexpr double weight_of_low_frequencies = 0.005;
constexpr std::array low_frequencies_rad{1.5 * std::numbers::pi, units::rad_per_turn};

double square_sum_about_mean(const PhaseSamples& samples) {
    const auto power_w = as_vector(samples.power_w);
    return (power_w.array() - power_w.mean()).square().sum();
}

void describe_fit(PhaseErrors& errors, std::span<const PhaseSamples> flights, const PhaseFit& fit) {
    double left = 0.0;
    double about_means = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        left += std::pow(fit.flights[i].rms_w, 2) * static_cast<double>(fit.flights[i].samples);
        about_means += square_sum_about_mean(flights[i]);
        const int order = static_cast<int>(fit.flights[i].fourier.cos_w.size());
        errors.condition =
            std::max(errors.condition, basis_condition(fourier_basis(flights[i].tau, order, fit.theta_rad)));
    }
    errors.r2 = about_means > 0.0 ? 1.0 - left / about_means : 1.0;
    errors.frequency_is_fixed = fit.flights.front().fourier.cos_w.empty() || is_constant(flights);
}

/// What the nodes say of a linear function of the coefficients which depends on theta: row(theta) c.
template <typename Row>
StudentMixture mixture_of(std::span<const PosteriorNode> nodes, const Row& row) {
    StudentMixture mixture;
    for (const auto& node : nodes) {
        const Eigen::VectorXd at = row(node.theta_rad);
        mixture.weight.push_back(node.weight);
        mixture.location.push_back(at.dot(node.coefficients));
        mixture.scale.push_back(std::sqrt(std::max(0.0, at.dot(node.scale * at))));
    }
    return mixture;
}

/// The row of the mean curve at tau for a frequency.
Eigen::VectorXd curve_row(Eigen::Index coefficients, double theta_rad, double tau) {
    const std::array at{tau};
    return fourier_basis(at, static_cast<int>(coefficients - 1) / 2, theta_rad).row(0).transpose();
}

StudentMixture curve_mixture(const ErrorAnalysis& analysis, double tau) {
    return mixture_of(analysis.curve->posterior.nodes, [&](double theta_rad) {
        return curve_row(analysis.curve->coefficients_w.size(), theta_rad, tau);
    });
}

Interval around(Interval interval, double value) {
    return {std::min(interval.low, value), std::max(interval.high, value)};
}

/// Of the nodes below a frequency alone; without weights if they hold too little.
StudentMixture below(const StudentMixture& mixture, std::span<const PosteriorNode> nodes, double theta_rad) {
    StudentMixture part;
    double sum = 0.0;
    for (std::size_t i = 0; i < mixture.weight.size(); ++i) {
        if (nodes[i].theta_rad > theta_rad) break;
        sum += mixture.weight[i];
        part.weight.push_back(mixture.weight[i]);
        part.location.push_back(mixture.location[i]);
        part.scale.push_back(mixture.scale[i]);
    }
    if (sum < weight_of_low_frequencies) return {};
    for (double& weight : part.weight) weight /= sum;
    return part;
}

/// A coefficient's interval: of the mixture, and of the frequencies at which harmonics are alike by themselves as long
/// as these are not ruled out. There coefficients range widest, in little of the weight.
Interval coefficient_interval(const ErrorAnalysis& analysis, const StudentMixture& mixture, const StudentCdf& cdf,
                              double value) {
    auto interval = around(mixture_interval(mixture, cdf), value);
    for (const double theta_rad : low_frequencies_rad) {
        const auto part = below(mixture, analysis.curve->posterior.nodes, theta_rad);
        if (part.weight.empty()) continue;
        const auto [low, high] = mixture_interval(part, cdf);
        interval = around(around(interval, low), high);
    }
    return interval;
}

double sd_of_frequency(std::span<const PosteriorNode> nodes) {
    double mean = 0.0;
    for (const auto& node : nodes) mean += node.weight * node.theta_rad;
    double sum = 0.0;
    for (const auto& node : nodes) sum += node.weight * std::pow(node.theta_rad - mean, 2);
    return std::sqrt(sum);
}

/// Power without a frequency: what is known of a constant, as that of a series whose harmonics are 0.
void add_harmonics(std::vector<PosteriorNode>& nodes, Eigen::Index size) {
    for (auto& node : nodes) {
        node.coefficients.conservativeResizeLike(Eigen::VectorXd::Zero(size));
        node.scale.conservativeResizeLike(Eigen::MatrixXd::Zero(size, size));
    }
}

void fill_coefficients(ErrorAnalysis& analysis, double duration_s) {
    auto& errors = analysis.errors;
    auto& intervals = errors.intervals.emplace();
    const StudentCdf cdf(errors.degrees_of_freedom);
    const auto size = analysis.curve->coefficients_w.size();
    for (Eigen::Index k = 0; k < size; ++k) {
        Eigen::VectorXd unit = Eigen::VectorXd::Unit(size, k);
        const auto mixture = mixture_of(analysis.curve->posterior.nodes, [&](double) { return unit; });
        const double sd = mixture_sd(mixture, errors.degrees_of_freedom);
        const auto [low, high] = coefficient_interval(analysis, mixture, cdf, analysis.curve->coefficients_w(k));
        (k == 0 ? errors.a0_w : k % 2 == 1 ? errors.cos_w.emplace_back() : errors.sin_w.emplace_back()) = sd;
        (k == 0       ? intervals.a0_w
         : k % 2 == 1 ? intervals.cos_w.emplace_back()
                      : intervals.sin_w.emplace_back()) = {low, high};
    }
    if (errors.frequency_is_fixed) {
        intervals.omega_rad_per_s = {analysis.theta_rad / duration_s, analysis.theta_rad / duration_s};
        return;
    }
    const auto [low, high] = around(frequency_interval(analysis.curve->posterior), analysis.theta_rad);
    intervals.omega_rad_per_s = {low / duration_s, high / duration_s};
    errors.omega_rad_per_s = sd_of_frequency(analysis.curve->posterior.nodes) / duration_s;
}

void fill_noise(PhaseErrors& errors, const FrequencyPosterior& posterior, std::span<const PhaseSamples> flights) {
    for (const auto& node : posterior.nodes) errors.autocorrelation += node.weight * node.autocorrelation;
    errors.autocorrelation = std::clamp(errors.autocorrelation, 0.0, 1.0);
    errors.noise_lasts = is_autocorrelation_at_limit(posterior);
    for (const auto& flight : flights) {
        const auto sorted = sort_by_time({flight.tau, flight.power_w});
        errors.effective_samples +=
            effective_samples(sample_correlation(sorted.tau, median_gap(sorted.tau), errors.autocorrelation));
    }
}

FrequencyPosterior posterior_of_fit(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                    std::span<const double> weights, int order) {
    std::vector<ScaledSamples> values;
    for (std::size_t i = 0; i < flights.size(); ++i)
        values.push_back(pseudo_observations(flights[i], fit.flights[i], fit));
    return frequency_posterior(values, weights, {order, fit.range, fit.theta_rad});
}

constexpr int points_a_side = 20;

/// The flights' least common sum of squares at one frequency [W^2].
double square_sum_w2(std::span<const PhaseSamples> flights, int order, double theta_rad) {
    double sum = 0.0;
    for (const auto& flight : flights) {
        const auto fit = solve_least_squares(fourier_basis(flight.tau, order, theta_rad), as_vector(flight.power_w));
        if (!fit) return std::numeric_limits<double>::infinity();
        sum += fit->residual_square_sum;
    }
    return sum;
}

}  // namespace

ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights) {
    ErrorAnalysis analysis;
    MeanCurve curve;
    auto& errors = analysis.errors;
    double duration_s = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const Eigen::VectorXd own = coefficients_of(fit.flights[i].fourier);
        if (i == 0) curve.coefficients_w = Eigen::VectorXd::Zero(own.size());
        curve.coefficients_w += weights[i] * own;
        duration_s += weights[i] * flights[i].duration_s;
    }
    analysis.theta_rad = fit.theta_rad;
    describe_fit(errors, flights, fit);
    const int order = errors.frequency_is_fixed ? 0 : static_cast<int>(fit.flights.front().fourier.cos_w.size());
    curve.posterior = posterior_of_fit(flights, fit, weights, order);
    add_harmonics(curve.posterior.nodes, curve.coefficients_w.size());
    for (const auto& node : curve.posterior.nodes) errors.degrees_of_freedom += node.weight * node.degrees_of_freedom;
    fill_noise(errors, curve.posterior, flights);
    analysis.curve = std::make_shared<const MeanCurve>(std::move(curve));
    fill_coefficients(analysis, duration_s);
    constexpr int points = 41;
    double variance = 0.0;
    for (int i = 0; i < points; ++i) {
        variance += std::pow(curve_standard_error_w(analysis, (i + 0.5) / points), 2) / points;
    }
    errors.curve_w = std::sqrt(variance);
    return analysis;
}

double curve_standard_error_w(const ErrorAnalysis& analysis, double tau) {
    return mixture_sd(curve_mixture(analysis, tau), analysis.errors.degrees_of_freedom);
}

std::vector<Interval> curve_intervals_w(const ErrorAnalysis& analysis, std::span<const double> tau) {
    const StudentCdf cdf(analysis.errors.degrees_of_freedom);
    std::vector<Interval> intervals;
    for (const double at : tau) {
        const double fitted = curve_row(analysis.curve->coefficients_w.size(), analysis.theta_rad, at)
                                  .dot(analysis.curve->coefficients_w);
        intervals.push_back(around(mixture_interval(curve_mixture(analysis, at), cdf), fitted));
    }
    return intervals;
}

FrequencyProfile frequency_profile(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                                   const ErrorAnalysis& analysis) {
    const auto order = static_cast<int>(fit.flights.front().fourier.cos_w.size());
    FrequencyProfile profile{{}, {}, fit.range.low_rad, fit.range.high_rad, true, true};
    if (order == 0 || analysis.errors.frequency_is_fixed) return profile;

    const auto [low, high] = frequency_interval(analysis.curve->posterior);
    profile.low_rad = std::min(low, fit.theta_rad);
    profile.high_rad = std::max(high, fit.theta_rad);
    profile.low_is_open = analysis.curve->posterior.is_open_below;
    profile.high_is_open = analysis.curve->posterior.is_open_above;
    const auto square_sum = [&](double theta_rad) { return square_sum_w2(flights, order, theta_rad); };

    const double first = std::max(fit.range.low_rad, 2.0 * profile.low_rad - fit.theta_rad);
    const double last = std::min(fit.range.high_rad, 2.0 * profile.high_rad - fit.theta_rad);
    for (int i = -points_a_side; i <= points_a_side; ++i) {
        const double part = static_cast<double>(i) / points_a_side;
        const double reach = i < 0 ? fit.theta_rad - first : last - fit.theta_rad;
        if (reach <= 0.0 && i != 0) continue;
        const double theta_rad = fit.theta_rad + part * reach;
        profile.theta_rad.push_back(theta_rad);
        profile.rms_w.push_back(std::sqrt(square_sum(theta_rad) / static_cast<double>(fit.samples)));
    }
    return profile;
}

std::vector<double> sample_correlation(std::span<const double> tau, double step, double autocorrelation) {
    std::vector<double> correlation(tau.size(), 0.0);
    for (std::size_t j = 1; j < tau.size(); ++j) {
        correlation[j] = std::pow(autocorrelation, (tau[j] - tau[j - 1]) / step);
    }
    return correlation;
}

double effective_samples(std::span<const double> correlation) {
    const auto count = static_cast<double>(correlation.size());
    double earlier = 0.0;  // the correlations of sample j with all before it
    double sum = count;
    for (const double decay : correlation) {
        earlier = decay * (1.0 + earlier);
        sum += 2.0 * earlier;
    }
    return count * count / sum;
}

}  // namespace flightwatt::mechanical
