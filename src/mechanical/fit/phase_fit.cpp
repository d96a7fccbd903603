#include "mechanical/fit/phase_fit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// The fewer periods a phase has, the more alike its harmonics are, and noise in the coefficients grows: at order 3 the
/// basis's condition is 1 at 2 pi, 38 at the paper's landing (3.63), 108 at pi, but 2500 at 2 rad and 230000 at 1 rad.
constexpr double min_theta_rad = std::numbers::pi;
/// 120 in ten minutes are 5 s each: nothing that an aircraft does over and over in cruise is faster.
constexpr double max_periods = 120.0;
constexpr double max_autocorrelation = 0.99;  ///< such noise lasts for 200 samples
constexpr double bound_tolerance = 1e-6;      ///< nearer to an end than this part of it is standing at it
/// The likeness of a harmonic's columns up to which their worse direction is told with at least half the information.
constexpr double max_alike = 0.5;
constexpr double constant_level = 1e-12;  ///< power that varies less than this part of its size is constant

void check_options(const PhaseFitOptions& options) {
    if (options.order < 0 || options.order > max_order) {
        throw UsageError(
            fmt::format("the order of the Fourier series is {}, expected 0 to {}", options.order, max_order));
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
    return fit_at_frequency(scaling.flights, order, std::clamp(units::rad_per_turn, range.low_rad, range.high_rad));
}

/// The correlation of neighbouring residuals, and so how many are as good as independent. White noise would show a
/// correlation of - coefficients / samples, because the curves follow it. One standard error is added: few samples
/// hardly show whether noise lasts.
void describe_noise(PhaseFit& fit, const Scaling& scaling, const JointFit& joint) {
    double squares = 0.0;
    double products = 0.0;  // of neighbours
    double samples = 0.0;
    double coefficients = 0.0;
    for (std::size_t i = 0; i < scaling.flights.size(); ++i) {
        const auto sorted = sort_by_time(scaling.flights[i]);
        const auto residual = fourier_residual(sorted, joint.theta_rad, joint.coefficients[i]).residual;
        squares += residual.squaredNorm();
        products += residual.head(residual.size() - 1).dot(residual.tail(residual.size() - 1));
        samples += static_cast<double>(residual.size());
        coefficients += static_cast<double>(joint.coefficients[i].size());
    }
    const double freedom = samples - coefficients;
    const double r =
        squares > 0.0 ? (freedom * products / squares + coefficients) / samples + 1.0 / std::sqrt(samples) : 0.0;
    fit.autocorrelation = std::clamp(r, 0.0, max_autocorrelation);
    fit.degrees_of_freedom = std::max(1.0, freedom * (1.0 - fit.autocorrelation) / (1.0 + fit.autocorrelation));
}

/// Frequencies at which the highest harmonic turns by more than the scan's step otherwise and which the samples allow by
/// an F test (95 %), the best first.
std::vector<double> rival_frequencies(const PhaseFit& fit, const JointFit& joint, const FrequencyScan& scan) {
    constexpr std::size_t most = 100;
    const double least = std::accumulate(joint.square_sum.begin(), joint.square_sum.end(), 0.0);
    const double max_square_sum =
        least * (1.0 + std::pow(student_t_half_width(fit.degrees_of_freedom), 2) / fit.degrees_of_freedom);
    std::vector<std::pair<double, double>> found;  // sum of squares, frequency
    for (std::size_t i = 0; i < scan.theta_rad.size(); ++i)
        if (std::abs(scan.theta_rad[i] - joint.theta_rad) > scan.step_rad && scan.square_sum[i] < max_square_sum)
            found.emplace_back(scan.square_sum[i], scan.theta_rad[i]);
    std::ranges::sort(found);
    found.resize(std::min(found.size(), most));
    std::vector<double> rivals(found.size());
    std::ranges::transform(found, rivals.begin(), &std::pair<double, double>::second);
    return rivals;
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
    FrequencyRange range{min_theta_rad, units::rad_from_turns(max_periods)};
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
        const auto joint = least_squares(scaling, options.order, range, scan ? &*scan : nullptr);
        auto fit = result_of(flights, scaling, joint, range);
        describe_noise(fit, scaling, joint);
        if (scan) fit.rivals_rad = rival_frequencies(fit, joint, *scan);
        hold_above_floor(flights, fit);
        return fit;
    } catch (const NoResultError& error) {
        throw NoResultError(fmt::format("{}: {}", to_string(phase), error.what()));
    }
}

}  // namespace flightwatt::mechanical
