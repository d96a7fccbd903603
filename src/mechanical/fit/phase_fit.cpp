#include "mechanical/fit/phase_fit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/fit/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/QR>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Alternating projections onto the curves above the limit, the series, and those of the same mean power; the harmonics
/// of the result are scaled by the rest.
void lift_above(const Eigen::MatrixXd& basis, Eigen::VectorXd& coefficients, double min_w) {
    constexpr int rounds = 50;
    const double mean_w = std::max((basis * coefficients).mean(), min_w);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
    for (int round = 0; round < rounds; ++round) {
        coefficients = qr.solve((basis * coefficients).cwiseMax(min_w));
        coefficients(0) += mean_w - (basis * coefficients).mean();
    }
    const double lowest_w = (basis * coefficients).minCoeff();
    if (lowest_w >= min_w) return;
    const double fraction = (mean_w - min_w) / (mean_w - lowest_w);
    coefficients *= fraction;
    coefficients(0) += (1.0 - fraction) * mean_w;
}

/// Changes the harmonics of curves that fall below 0, at the same mean power, so that they do not. Sets
/// PhaseFit::is_clamped.
void hold_above_zero(std::span<const PhaseSamples> flights, PhaseFit& fit) {
    constexpr double between_points = 1e-3;  // of a curve's range
    double square_sum = 0.0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        auto& flight = fit.flights[i];
        const auto points = curve_point_count(flight.fourier, flight.duration_s);
        const auto curve = curve_w(flight.fourier, flight.duration_s, points);
        const auto [low_w, high_w] = std::ranges::minmax(curve);
        if (low_w < 0.0 && mean(curve) > 0.0) {  // else the measured power is negative
            std::vector<double> tau(points);     // the middles of equal parts, as curve_w
            for (std::size_t k = 0; k < points; ++k)
                tau[k] = (static_cast<double>(k) + 0.5) / static_cast<double>(points);
            Eigen::VectorXd coefficients = coefficients_of(flight.fourier);
            const auto order = static_cast<int>(flight.fourier.cos_w.size());
            lift_above(fourier_basis(tau, order, fit.theta_rad), coefficients, between_points * (high_w - low_w));
            flight.fourier = series_of(coefficients, flight.fourier.omega_rad_per_s);
            const auto residual = residual_of(flights[i], fit.theta_rad, coefficients);
            flight.rms_w = std::sqrt(residual.squaredNorm() / static_cast<double>(flight.samples));
            fit.is_clamped = true;
        }
        square_sum += flight.rms_w * flight.rms_w * static_cast<double>(flight.samples);
    }
    if (fit.is_clamped) fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
}

/// With fewer periods a phase's harmonics become collinear, and noise in the coefficients grows: at order 3 the basis's
/// condition is 1 at 2 pi, 38 at the paper's landing (3.63), 108 at pi, but 2500 at 2 rad and 230000 at 1 rad.
constexpr double min_theta_rad = std::numbers::pi;
/// 120 in ten minutes are 5 s each: no periodic manoeuvre of a cruise is faster.
constexpr double max_periods = 120.0;
constexpr double max_autocorrelation = 0.99;  ///< such noise lasts for 200 samples
/// From a flight's Nyquist frequency, of the highest harmonic: nearer, evenly spread samples do not determine both its
/// columns with half the information or more.
constexpr double below_nyquist_rad = 1.9;

void check_options(const PhaseFitOptions& options) {
    if (options.order < 0 || options.order > max_order) {
        throw UsageError(
            fmt::format("the order of the Fourier series is {}, expected 0 to {}", options.order, max_order));
    }
}

/// Power less its flight's mean; 0 where it varies by no more than rounding.
struct CentredFlights {
    std::vector<PhaseSamples> flights;
    std::vector<double> mean_w;
};

CentredFlights centred_flights(std::span<const PhaseSamples> flights) {
    CentredFlights centred{{flights.begin(), flights.end()}, {}};
    const bool constant = is_constant(flights);
    for (auto& flight : centred.flights) {
        centred.mean_w.push_back(mean(flight.power_w));
        for (double& power_w : flight.power_w) power_w = constant ? 0.0 : power_w - centred.mean_w.back();
        if (constant) flight.scan.reset();
    }
    return centred;
}

/// The correlation of neighbouring residuals, and the number of independent ones. White noise has a correlation of -
/// coefficients / samples, because the curves follow it. One standard error is added, as few samples poorly determine
/// it.
void describe_noise(PhaseFit& fit, std::span<const PhaseSamples> centred, const JointFit& joint) {
    double squares = 0.0;
    double products = 0.0;  // of neighbours
    double samples = 0.0;
    double coefficients = 0.0;
    for (std::size_t i = 0; i < centred.size(); ++i) {
        const auto residual = residual_of(centred[i], joint.theta_rad, joint.coefficients[i]);
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

/// Frequencies more than a step of the scan away that an F test (95 %) does not reject, the best first.
std::vector<double> rival_frequencies(const PhaseFit& fit, const JointFit& joint, const FrequencyScan& scan) {
    constexpr std::size_t max_rivals = 100;
    const double min_square_sum = std::accumulate(joint.square_sum.begin(), joint.square_sum.end(), 0.0);
    const double max_square_sum =
        min_square_sum * (1.0 + std::pow(student_t_half_width(fit.degrees_of_freedom), 2) / fit.degrees_of_freedom);
    std::vector<std::pair<double, double>> found;  // sum of squares, frequency
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i) {
        const double theta_rad = scan.grid.theta_rad(i);
        if (std::abs(theta_rad - joint.theta_rad) > scan.grid.step_rad && scan.square_sum[i] < max_square_sum)
            found.emplace_back(scan.square_sum[i], theta_rad);
    }
    std::ranges::sort(found);
    found.resize(std::min(found.size(), max_rivals));
    std::vector<double> rivals(found.size());
    std::ranges::transform(found, rivals.begin(), &std::pair<double, double>::second);
    return rivals;
}

PhaseFit result_of(const CentredFlights& centred, const JointFit& joint, const FrequencyRange& range) {
    PhaseFit fit;
    fit.theta_rad = joint.theta_rad;
    fit.range = range;
    double square_sum = 0.0;
    for (std::size_t i = 0; i < centred.flights.size(); ++i) {
        const auto& flight = centred.flights[i];
        FlightCurve curve{flight.flight, flight.duration_s, {}, 0.0, flight.tau.size()};
        curve.fourier = series_of(joint.coefficients[i], joint.theta_rad / curve.duration_s);
        curve.fourier.a0_w += centred.mean_w[i];
        curve.rms_w = std::sqrt(joint.square_sum[i] / static_cast<double>(curve.samples));
        square_sum += joint.square_sum[i];
        fit.samples += curve.samples;
        fit.flights.push_back(std::move(curve));
    }
    fit.rms_w = std::sqrt(square_sum / static_cast<double>(fit.samples));
    return fit;
}

}  // namespace

FrequencyRange admissible_frequencies(std::span<const PhaseSamples> flights, const PhaseFitOptions& options) {
    check_options(options);
    FrequencyRange range{min_theta_rad, units::rad_from_turns(max_periods)};
    for (const auto& flight : flights) {
        const double gap = median_gap(flight.tau);
        // A constant has no frequency: the limit of a first order is enough.
        const int order = std::max(1, options.order);
        const double nyquist = gap > 0.0 ? std::numbers::pi / (order * gap) : 0.0;
        if (nyquist <= range.low_rad) {
            if (options.order == 0) continue;
            throw NoResultError(
                fmt::format("flight '{}': {} samples, {:.3g} of the phase apart, are too sparse for a "
                            "Fourier series of order {}",
                            flight.flight, flight.tau.size(), gap, options.order));
        }
        // If not even the lowest is determined, the gap alone limits the range.
        const double determined_rad = nyquist - below_nyquist_rad / order;
        range.high_rad = std::min(range.high_rad, determined_rad > range.low_rad ? determined_rad : nyquist);
    }
    return range;
}

PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options) {
    check_options(options);
    if (flights.empty())
        throw NoResultError(
            fmt::format("no flight has a {0} to fit: add a log with a complete {0}, from "
                        "take-off to landing",
                        phase_word(phase)));
    for (const auto& flight : flights) {
        if (flight.tau.size() >= min_samples(options.order)) continue;
        throw NoResultError(
            fmt::format("flight '{}' has {} samples in {}, a Fourier series of order {} needs {}: "
                        "exclude its {}, or lower the order",
                        flight.flight, flight.tau.size(), phase_word(phase), options.order, min_samples(options.order),
                        phase_word(phase)));
    }
    const auto centred = centred_flights(flights);
    const int order = options.order;
    try {
        const auto range = admissible_frequencies(flights, options);
        FrequencyScan scan;
        double theta_rad = std::clamp(units::rad_per_turn, range.low_rad, range.high_rad);
        if (order > 0) {
            scan = scan_frequencies(centred.flights, order, range);
            theta_rad = find_frequency(centred.flights, order, range, scan);
        }
        const auto joint = fit_at_frequency(centred.flights, order, theta_rad);
        auto fit = result_of(centred, joint, range);
        describe_noise(fit, centred.flights, joint);
        fit.rivals_rad = rival_frequencies(fit, joint, scan);
        hold_above_zero(flights, fit);
        return fit;
    } catch (const NoResultError& error) {
        throw NoResultError(fmt::format("{}: {}", phase_word(phase), error.what()));
    }
}

}  // namespace flightwatt::mechanical
