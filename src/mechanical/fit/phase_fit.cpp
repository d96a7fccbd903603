#include "mechanical/fit/phase_fit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double bound_tolerance = 1e-6;  ///< nearer to an end than this part of it is standing at it
/// The likeness of a harmonic's columns up to which their worse direction is told with at least half the information.
constexpr double max_alike = 0.5;
constexpr double constant_level = 1e-12;  ///< power that varies less than this part of its size is constant

void check_options(const PhaseFitOptions& options) {
    if (options.order < 0 || options.order > max_order) {
        throw UsageError(
            fmt::format("the order of the Fourier series is {}, expected 0 to {}", options.order, max_order));
    }
    if (!(options.min_theta_rad > 0.0) || !std::isfinite(options.min_theta_rad)) {
        throw UsageError(
            fmt::format("the lowest omega * duration is {} rad, expected more than 0", options.min_theta_rad));
    }
    if (!(units::rad_from_turns(options.max_periods) > options.min_theta_rad) || !std::isfinite(options.max_periods)) {
        throw UsageError(fmt::format("at most {} periods a phase are less than the lowest omega * duration, {} rad",
                                     options.max_periods, options.min_theta_rad));
    }
}

void check_samples(flight::Phase phase, const PhaseSamples& samples) {
    const auto refuse = [&](const std::string& what) {
        throw InputError({samples.flight}, fmt::format("{}: {}", to_string(phase), what));
    };
    if (samples.tau.size() != samples.power_w.size()) {
        refuse(fmt::format("{} times and {} powers, expected as many of each", samples.tau.size(),
                           samples.power_w.size()));
    }
    if (!(samples.duration_s > 0.0) || !std::isfinite(samples.duration_s)) {
        refuse(fmt::format("duration_s = {} is not positive", samples.duration_s));
    }
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        if (!(samples.tau[i] >= 0.0 && samples.tau[i] <= 1.0)) {
            refuse(fmt::format("sample {} at {} of the phase, expected 0 to 1", i + 1, samples.tau[i]));
        }
        if (!std::isfinite(samples.power_w[i])) {
            refuse(fmt::format("sample {}: power_w is not finite: {}", i + 1, samples.power_w[i]));
        }
    }
}

struct Scaling {
    std::vector<ScaledSamples> flights;
    std::vector<double> mean_w;  ///< a flight
    double unit_w = 1.0;
};

Scaling scaled(std::span<const PhaseSamples> flights) {
    Scaling scaling;
    double square_sum = 0.0;
    double largest = 0.0;
    double count = 0.0;
    for (const auto& flight : flights) {
        ScaledSamples samples{flight.tau, flight.power_w, flight.flight};
        const double mean_w = mean(flight.power_w);
        for (double& value : samples.value) {
            largest = std::max(largest, std::abs(value));
            value -= mean_w;
            square_sum += value * value;
        }
        count += static_cast<double>(flight.tau.size());
        scaling.flights.push_back(std::move(samples));
        scaling.mean_w.push_back(mean_w);
    }
    const double deviation_w = std::sqrt(square_sum / count);
    const bool varies = deviation_w > constant_level * largest;
    if (varies) scaling.unit_w = deviation_w;
    for (auto& flight : scaling.flights)
        for (double& value : flight.value) value = varies ? value / deviation_w : 0.0;
    if (!varies) return scaling;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        scaling.flights[i].scan = flights[i].scan;
        scaling.flights[i].scan_unit = 1.0 / deviation_w;
    }
    return scaling;
}

FrequencyBound bound_reached(const FrequencyRange& range, double theta_rad) {
    const double near = bound_tolerance * theta_rad;
    if (theta_rad - range.low_rad <= near) return FrequencyBound::low;
    if (range.high_rad - theta_rad <= near) return FrequencyBound::high;
    return FrequencyBound::none;
}

JointFit least_squares(const Scaling& scaling, int order, const FrequencyRange& range, const FrequencyScan* scan) {
    if (scan)
        return refine_jointly(scaling.flights, order, range, find_frequency(scaling.flights, order, range, *scan));
    // The values less their means are 0 but for noise, whatever the frequency.
    JointFit joint;
    joint.theta_rad = std::clamp(units::rad_per_turn, range.low_rad, range.high_rad);
    for (const auto& flight : scaling.flights) {
        const auto& value = flight.value;
        joint.coefficients.emplace_back(Eigen::VectorXd::Zero(1));
        joint.square_sum.push_back(std::inner_product(value.begin(), value.end(), value.begin(), 0.0));
    }
    return joint;
}

/// Whether the samples allow frequencies at which the highest harmonic turns by more than the scan's step otherwise: a
/// likelihood ratio (95 %) in which samples count as independent ones do.
bool is_open(const Scaling& scaling, const JointFit& joint, const FrequencyScan& scan, int order) {
    constexpr double max_log_ratio = 1.92;  // half of chi^2's quantile with one degree of freedom
    double squares = 0.0;
    double products = 0.0;  // of neighbours
    double freedom = 0.0;
    for (std::size_t i = 0; i < scaling.flights.size(); ++i) {
        const auto samples = sort_by_time(scaling.flights[i]);
        const auto residual = fourier_residual(samples, joint.theta_rad, joint.coefficients[i]).residual;
        squares += residual.squaredNorm();
        products += residual.head(residual.size() - 1).dot(residual.tail(residual.size() - 1));
        freedom += static_cast<double>(residual.size() - coefficient_count(order));
    }
    const double r = squares > 0.0 ? std::max(0.0, products / squares) : 0.0;
    const double independent = freedom * (1.0 - r) / (1.0 + r);
    const double max_square_sum = squares * std::exp(2.0 * max_log_ratio / independent);
    for (std::size_t i = 0; i < scan.theta_rad.size(); ++i) {
        const double apart_rad = std::abs(scan.theta_rad[i] - joint.theta_rad);
        if (apart_rad > scan.step_rad && scan.square_sum[i] < max_square_sum) return true;
    }
    return false;
}

PhaseFit result_of(std::span<const PhaseSamples> flights, const Scaling& scaling, const JointFit& joint,
                   const FrequencyRange& range) {
    PhaseFit fit;
    fit.theta_rad = joint.theta_rad;
    fit.range = range;
    const bool has_frequency = joint.coefficients.front().size() > 1;
    if (has_frequency) fit.range.at_bound = bound_reached(range, joint.theta_rad);
    double square_sum = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        FlightCurve curve;
        curve.flight = flights[i].flight;
        curve.duration_s = flights[i].duration_s;
        curve.samples = flights[i].tau.size();
        curve.fourier = series_of(scaling.unit_w * joint.coefficients[i], joint.theta_rad / curve.duration_s);
        curve.fourier.a0_w += scaling.mean_w[i];
        curve.rms_w = scaling.unit_w * std::sqrt(joint.square_sum[i] / static_cast<double>(curve.samples));
        square_sum += joint.square_sum[i];
        fit.samples += curve.samples;
        fit.flights.push_back(std::move(curve));
    }
    fit.loss_scale_w = joint.noise_scale * scaling.unit_w;
    fit.rms_w = scaling.unit_w * std::sqrt(square_sum / static_cast<double>(fit.samples));
    return fit;
}

/// How alike the two columns of the highest harmonic are on the samples, 0 to 1: at 1 one vanishes, or both are one.
double likeness(const std::vector<double>& tau, int order, double theta_rad) {
    std::complex<double> sum = 0.0;
    for (const double at : tau) sum += std::polar(1.0, 2.0 * order * theta_rad * at);
    return std::abs(sum) / static_cast<double>(tau.size());
}

/// The highest frequency, from `high_rad` down, at which the samples tell the highest harmonic's amplitude and phase:
/// evenly spread ones do not at half their own frequency, whatever happens between them.
double told_frequency(const std::vector<double>& tau, int order, double low_rad, double high_rad) {
    const double step_rad = std::numbers::pi / (16.0 * std::max(1, order));  // a sixteenth of the likeness's peak
    double theta_rad = high_rad;
    while (theta_rad > low_rad && likeness(tau, order, theta_rad) > max_alike) theta_rad -= step_rad;
    return theta_rad;
}

}  // namespace

FrequencyRange admissible_frequencies(std::span<const PhaseSamples> flights, const PhaseFitOptions& options) {
    check_options(options);
    FrequencyRange range{options.min_theta_rad, units::rad_from_turns(options.max_periods)};
    for (const auto& flight : flights) {
        const double gap = median_gap(flight.tau);
        // A constant needs no frequency: it is content with what a first order needs.
        const double nyquist = gap > 0.0 ? std::numbers::pi / (std::max(1, options.order) * gap) : 0.0;
        if (nyquist <= range.low_rad) {
            throw NoResultError(
                fmt::format("flight '{}': {} samples, {:.3g} of the phase apart, are too sparse for a "
                            "Fourier series of order {}",
                            flight.flight, flight.tau.size(), gap, options.order));
        }
        range.high_rad = std::min(range.high_rad, nyquist);
        // Nothing is told even of the lowest: then the range stays what the gap allows.
        const double told = told_frequency(flight.tau, std::max(1, options.order), range.low_rad, range.high_rad);
        if (told > range.low_rad) range.high_rad = told;
    }
    return range;
}

ScaledSamples pseudo_observations(const PhaseSamples& samples, const FlightCurve& curve, const PhaseFit& fit) {
    ScaledSamples values{samples.tau, samples.power_w, samples.flight, samples.scan};
    if (fit.loss == Loss::none || fit.loss_scale_w <= 0.0) return values;
    values.scan = nullptr;
    double slope = 0.0;
    std::vector<double> residuals;
    for (std::size_t j = 0; j < values.tau.size(); ++j) {
        const double fitted = power_w(curve.fourier, values.tau[j] * curve.duration_s);
        const double scales = (values.value[j] - fitted) / fit.loss_scale_w;
        slope += sample_influence(fit.loss, scales) / static_cast<double>(values.tau.size());
        residuals.push_back((values.value[j] - fitted) * sample_weight(fit.loss, scales));
        values.value[j] = fitted;
    }
    if (slope <= 0.0) throw NoResultError("too many samples are down-weighted to know the fit's errors");
    for (std::size_t j = 0; j < residuals.size(); ++j) values.value[j] += residuals[j] / slope;
    return values;
}

PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options) {
    check_options(options);
    if (flights.empty()) throw NoResultError(fmt::format("no flight has a {} to fit", to_string(phase)));
    for (const auto& flight : flights) {
        check_samples(phase, flight);
        if (flight.tau.size() >= min_samples(options.order)) continue;
        throw NoResultError(
            fmt::format("flight '{}' has {} samples in {}, a Fourier series of order {} needs {}: "
                        "exclude its {}, or lower the order",
                        flight.flight, flight.tau.size(), to_string(phase), options.order, min_samples(options.order),
                        to_string(phase)));
    }
    const auto scaling = scaled(flights);
    try {
        const auto range = admissible_frequencies(flights, options);
        std::optional<FrequencyScan> scan;
        if (options.order > 0) scan = scan_frequencies(scaling.flights, options.order, range);
        auto joint = least_squares(scaling, options.order, range, scan ? &*scan : nullptr);
        if (options.loss != Loss::none) joint = refine_robustly(scaling.flights, range, std::move(joint));
        auto fit = result_of(flights, scaling, joint, range);
        fit.loss = options.loss;
        fit.is_frequency_open = scan && is_open(scaling, joint, *scan, options.order);
        hold_above_floor(flights, fit);
        return fit;
    } catch (const NoResultError& error) {
        throw NoResultError(fmt::format("{}: {}", to_string(phase), error.what()));
    }
}

}  // namespace flightwatt::mechanical
