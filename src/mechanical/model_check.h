#pragma once

#include "mechanical/mechanical_model.h"

#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// What a user should know of a model before it is used, a line each: a phase whose curve falls below 0 W, where a
/// drone takes no energy back; a phase whose errors are no more than a bound, because the noise of its samples is alike
/// for as long as the phase lasts (autocorrelation at max_autocorrelation).
std::vector<std::string> model_warnings(const MechanicalModel& model);

/// How the fit came to its curves where that is not least squares of all samples, a line each: samples that were left
/// out, a mean over frequencies, a curve that was held above 0 W.
std::vector<std::string> fit_notes(const MechanicalModel& model);

}  // namespace flightwatt::mechanical
