#pragma once

#include "mechanical/fit_records.h"

#include <span>

namespace flightwatt::mechanical {

/// Errors of the flights' mean curve from the noise of their samples (docs/methods.md, Errors of the fit): least
/// squares at the frequency found, at frequencies around it and at its rivals, as far as the samples admit them.
/// `flights`, `fit` and `weights` are in the same order; their samples are those that were fitted.
ErrorAnalysis analyse_errors(std::span<const PhaseSamples> flights, const PhaseFit& fit,
                             std::span<const double> weights);

/// The standard error [W] of the mean curve at tau in [0, 1] of the phase; its Student's t has
/// errors.degrees_of_freedom.
double curve_standard_error_w(const ErrorAnalysis& analysis, double tau);

}  // namespace flightwatt::mechanical
