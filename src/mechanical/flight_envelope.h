#pragma once

#include "mechanical/fit/phase_fit.h"
#include "mechanical/uncertainty/phase_uncertainty.h"

#include <cstddef>
#include <optional>
#include <span>

namespace flightwatt::mechanical {

/// So many points the model file's spread has, from begin to end of the phase.
inline constexpr std::size_t points_of_spread = 21;

/// How the flights' own curves differ about their weighted mean at `points` evenly spread parts of the phase
/// (two or more): the envelope of those with a weight, and the standard deviation of one flight
/// (docs/methods.md, Eq. 10). std::nullopt where
/// a single flight counts. This is where a new flight's curve may lie, not how well the mean is known.
std::optional<PhaseSpread> flight_envelope(const PhaseFit& fit, std::span<const double> weights,
                                           std::size_t points = points_of_spread);

/// Standard error [W] of the mean as that of all flights that might have been flown, at point i of the
/// spread: sd / sqrt(counted_flights). Its Student's t has counted_flights - 1 degrees of freedom.
double population_standard_error_w(const PhaseSpread& spread, std::size_t i);

}  // namespace flightwatt::mechanical
