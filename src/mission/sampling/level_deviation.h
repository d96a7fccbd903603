#pragma once

#include "mission/mission.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// What the mission's own [uncertainty] states of that [W], if it does.
std::optional<double> stated_level_sd_w(const Mission& mission, flight::Phase phase);

/// Standard deviation [W] of a phase's mean mechanical power about the model's, of a flight to come: the
/// predictive one of mechanical/prediction.h. Throws InputError where there is no mechanical model, or one
/// that does not say how flights differ.
double level_sd_w(const Mission& mission, flight::Phase phase);

/// Standard deviation [points] of what a mission drains, from how the flights' mean powers differ: of each
/// phase, the drain of one standard deviation more mechanical power for as long as it is flown, beside the
/// configuration that draws most; the phases' variances add. The deviation of a flight from a model of few
/// flights is the predictive one of mechanical/prediction.h. Without resistance the drain is linear in power,
/// so that Gaussian levels make a Gaussian drain; with it, this errs on the safe side. Throws
/// InputError where there is no mechanical model, or one that does not say how flights differ; NoAnswerError
/// where the battery could not deliver that power.
double drain_sd_percent(const Mission& mission, const std::vector<compute::Configuration>& configurations);

/// What to plan for above a reserve, so that it is kept with `probability` (from 0.5, below 1): that quantile
/// of a Gaussian with the deviation above, taken as known. Throws std::invalid_argument for other
/// probabilities.
double margin_percent(const Mission& mission, const std::vector<compute::Configuration>& configurations,
                      double probability);

}  // namespace flightwatt::mission
