#pragma once

#include "mechanical/fit/phase_fit.h"

#include <span>

namespace flightwatt::mechanical {

/// Where the samples leave the frequency open, the mean of the curves over all frequencies and autocorrelations that
/// may be (frequency_posterior.h) is nearer to the truth than that of least squares. It takes the place of the fit's
/// curves where, over the phase, their mean is further from it than a quarter of its standard deviation, and where a
/// curve of least squares falls below 0 and below all that was measured: such power is held at the least of both. The
/// record stays a series of the order with one frequency (docs/methods.md, Eq. 13): of those that are within a tenth of
/// a standard deviation of the mean, the one with the smallest harmonics, for constants that cancel each other say
/// nothing. Sets PhaseFit::mean_curve and not_negative where it changes the curves; else the fit stays as it is.
void settle_curves(std::span<const PhaseSamples> flights, PhaseFit& fit);

}  // namespace flightwatt::mechanical
