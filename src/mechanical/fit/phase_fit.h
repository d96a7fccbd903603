#pragma once

#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit_records.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/phase_samples.h"

#include <span>

namespace flightwatt::mechanical {

/// Fits Fourier series to all flights: scans the whole range of theta, refines the lowest minima, and solves for the
/// coefficients. Curves do not fall below 0. Order 0 is each flight's own mean. Throws NoResultError
/// naming flight and phase for a flight with fewer than min_samples(order) samples or samples that do not determine the
/// series, and for no flights.
PhaseFit fit_phase(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options = {});

}  // namespace flightwatt::mechanical
