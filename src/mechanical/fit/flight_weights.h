#pragma once

#include "mechanical/fit_records.h"

#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// The weights of the flights of one phase, in [0, 1], in their order; their sum is 1 (docs/methods.md, Eq. 9). By
/// agreement outliers count little; one flight has 1, two have 1/2 each, equal curves have equal weights.
std::vector<double> flight_weights(const PhaseFit& fit, Weighting weighting);

/// The weighted average of the flights' coefficients and durations (docs/methods.md, Eq. 8), which have one theta.
PhaseModel average_phase(const PhaseFit& fit, std::span<const double> weights);

}  // namespace flightwatt::mechanical
