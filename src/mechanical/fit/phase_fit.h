#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/least_squares.h"
#include "mechanical/fit_records.h"

#include <span>

namespace flightwatt::mechanical {

/// Fits Fourier series to all flights: scans the whole range of theta, then refines theta and all coefficients jointly.
/// Curves do not fall below 0 (hold_above_floor). Order 0 is each flight's own mean. Throws InputError for invalid
/// samples (unequal lengths, tau outside [0, 1], not finite, duration not positive), NoResultError naming flight and
/// phase for a flight with fewer than min_samples(order) samples, for no flights, and for a fit that does not converge.
PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options = {});

/// Changes the harmonics of curves that fall below 0, at the same mean power, so that they do not; where the mean over
/// a fifth of the phase is negative by more than chance (95 %), that is the lower limit. Sets PhaseFit::is_clamped.
void hold_above_floor(std::span<const PhaseSamples> flights, PhaseFit& fit);

}  // namespace flightwatt::mechanical
