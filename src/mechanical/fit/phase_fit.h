#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/least_squares.h"

#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mechanical {

/// What a phase's curves are where the samples leave the frequency open.
enum class CurveEstimator {
    mean,          ///< the mean over all frequencies that may be; never below 0 unless that was measured
    least_squares  ///< that of the least sum of squares, whatever it is
};

constexpr std::string_view to_string(CurveEstimator curve) {
    return curve == CurveEstimator::mean ? "mean" : "least-squares";
}

constexpr std::optional<CurveEstimator> curve_from(std::string_view name) {
    for (const auto curve : {CurveEstimator::mean, CurveEstimator::least_squares})
        if (name == to_string(curve)) return curve;
    return std::nullopt;
}

struct PhaseFitOptions {
    int order = 3;  ///< of the Fourier series, 0 (a constant) to max_order
    /// Lowest omega * duration. The fewer periods a phase has, the more alike its harmonics are, and noise in
    /// the coefficients grows: at order 3 the basis's condition is 1 at 2 pi, 38 at the paper's landing (3.63),
    /// 108 at pi, but 2500 at 2 rad and 230000 at 1 rad.
    double min_theta_rad = std::numbers::pi;
    /// Most periods in a phase; the sampling may allow fewer. 120 in ten minutes are 5 s each: nothing that
    /// an aircraft does over and over in cruise is faster.
    double max_periods = 120.0;
    Loss loss = Loss::none;  ///< huber: outliers count less in the last refinement
    CurveEstimator curve = CurveEstimator::mean;
};

/// One flight's own curve in one phase, in that flight's own seconds.
struct FlightCurve {
    std::string flight;
    double duration_s = 0.0;
    FourierModel fourier;  ///< omega_rad_per_s = theta / duration_s
    double rms_w = 0.0;    ///< of the residuals
    std::size_t samples = 0;
};

/// All flights of one phase, fitted with one frequency in their own normalised time (Eq. 1).
struct PhaseFit {
    double theta_rad = 0.0;  ///< omega * duration, common to all
    FrequencyRange range;
    std::vector<FlightCurve> flights;  ///< in the order of the samples
    double rms_w = 0.0;                ///< of all flights' residuals together
    std::size_t samples = 0;
    Loss loss = Loss::none;
    double loss_scale_w = 0.0;           ///< of the noise as the loss saw it; 0 without a loss
    bool is_frequency_averaged = false;  ///< the curves are means over frequencies (average_over_frequencies)
    bool is_clamped = false;  ///< curves were kept from falling below 0, or below negative power that was measured
    std::shared_ptr<const FrequencyPosterior> posterior = {};  ///< if it was needed
    std::shared_ptr<const FrequencyScan> scan = {};  ///< of the samples [W^2]; none with a loss, or of order 0
};

/// So many samples a flight needs at least: one more than its coefficients.
std::size_t min_samples(int order);

/// Where theta may lie: from options.low_rad to options.max_periods periods, but not so high that in some
/// flight the highest harmonic would have less than two samples a period (of the median gap between samples), or that
/// its two columns are so alike on the samples that noise in one direction of them is more than twice (its variance)
/// what it is on well spread ones: as near to two samples a period as evenly spread ones would allow.
/// Throws UsageError for options that make no sense, NoResultError if the samples leave nothing of the range.
FrequencyRange admissible_frequencies(std::span<const PhaseSamples> flights, const PhaseFitOptions& options);

/// Fits Fourier series of the order to all flights: scans the whole range of theta, refines theta and all coefficients
/// together. A loss other than none starts from that answer, so outliers still take part in the search for the
/// frequency. Where the samples leave the frequency open the curves are settled (average_over_frequencies) unless
/// options.curve says otherwise. Order 0 is each flight's own mean (its theta, one period, has no effect). Throws
/// InputError for samples that are no samples (unequal lengths, tau outside [0, 1], not finite, duration not positive),
/// NoResultError naming flight and phase for a flight with fewer than min_samples(order) samples, for no flights, and
/// for a fit that does not converge.
PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options = {});

/// A flight's samples; after a robust fit its curve with Huber's pseudo-residuals, psi / mean psi', on which least
/// squares would have come to the same curve. Throws NoResultError if all samples are down-weighted.
ScaledSamples pseudo_observations(const PhaseSamples& samples, const FlightCurve& curve, const PhaseFit& fit);

/// Where the samples leave the frequency open, the mean of the curves over all frequencies and autocorrelations that
/// may be (frequency_posterior.h) is nearer to the truth than that of least squares. The frequency is open where its
/// 95 % interval, with that of least squares, lets the highest harmonic turn by more than 1 rad over the phase, and
/// noise and curve are told apart (noise_lasts). There the mean takes the place of the fit's curves if it is further
/// from them than a quarter of its standard deviation, if they fall below 0, or if their constant is implausible:
/// negative, or further from all power measured than that ranges. The record stays a series of the order with one
/// frequency (docs/methods.md, Eq. 13): of those that are within a tenth of a standard deviation of the mean and have
/// plausible constants, the one with the smallest harmonics.
/// A curve that falls below 0 is held above it, its mean power as before, unless power below 0 was measured: a mean
/// over a fifth of the phase that is negative by more than chance (95 %), which then is the least.
/// Sets PhaseFit::mean_curve and not_negative where it changes the curves, and PhaseFit::posterior.
void average_over_frequencies(std::span<const PhaseSamples> flights, PhaseFit& fit);

}  // namespace flightwatt::mechanical
