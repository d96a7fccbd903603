#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/least_squares.h"
#include "mechanical/fit_records.h"

#include <span>

namespace flightwatt::mechanical {

/// Fits Fourier series of the order to all flights: scans the whole range of theta, refines theta and all coefficients
/// together. Curves do not fall below 0 (hold_above_floor). Order 0 is each flight's own mean (its theta, one period,
/// has no effect). Throws InputError for samples that are no samples (unequal lengths, tau outside [0, 1], not finite,
/// duration not positive), NoResultError naming flight and phase for a flight with fewer than min_samples(order)
/// samples, for no flights, and for a fit that does not converge.
PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options = {});

/// Holds curves that fall below 0 above it, their mean power as before, unless power below 0 was measured: a mean over a
/// fifth of the phase that is negative by more than chance (95 %), which then is the least. Sets PhaseFit::is_clamped.
void hold_above_floor(std::span<const PhaseSamples> flights, PhaseFit& fit);

}  // namespace flightwatt::mechanical
