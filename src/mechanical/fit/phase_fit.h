#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/least_squares.h"
#include "mechanical/fit_records.h"

#include <span>

namespace flightwatt::mechanical {

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
