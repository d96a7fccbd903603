#pragma once

#include "mission/mission.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// What says how the mean mechanical power of a phase differs between flights.
enum class DeviationSource {
    none,
    stated,      ///< the mission's [uncertainty]
    conditions,  ///< the flights about what the mission's [conditions] say
    flights,     ///< the model's flights about their average
    fit_error    ///< the standard error of the fit alone, which is not how flights differ
};

/// Standard deviation of a phase's mean mechanical power about the model's, of a flight to come.
struct LevelDeviation {
    double sd_w = 0.0;
    DeviationSource source = DeviationSource::none;
    std::size_t flights = 0;  ///< that it is of, if of the model's
};

/// The first of the sources, in their order, that the mission has. Of the model's flights: their standard
/// deviation times sqrt(1 + sum of their squared weights), which is that of a new flight about an average of
/// few, taken as known. Needs a mechanical model.
LevelDeviation level_deviation(const MissionSetup& mission, flight::Phase phase);

/// The deviation [W] where it is how flights differ. Throws InputError where there is no mechanical model, or
/// one that does not say so.
double level_sd_w(const MissionSetup& mission, flight::Phase phase);

/// Standard deviation [points] of a mission's depletion, from how the flights' mean powers differ: of each
/// phase, the depletion by one standard deviation more mechanical power for as long as it is flown, beside the
/// configuration that draws most; the phases' variances add. Without resistance the depletion is linear in
/// power, so that Gaussian levels make a Gaussian depletion; with it, this errs on the safe side. Throws
/// InputError as level_sd_w; NoAnswerError where the battery could not deliver that power.
double soc_depletion_sd_percent(const MissionSetup& mission,
                                const std::vector<compute::Configuration>& configurations);

/// What to plan for above a reserve, so that it is kept with `probability` (from 0.5, below 1): that quantile
/// of a Gaussian with the deviation above, taken as known. Throws std::invalid_argument for other
/// probabilities.
double margin_percent(const MissionSetup& mission, const std::vector<compute::Configuration>& configurations,
                      double probability);

/// The mission with mechanical power raised by what flights exceed with 1 - probability: every phase by its
/// deviation (level_deviation) times its part in the deviation of the energy, times the Gaussian quantile. The
/// final SoC of the returned mission is the (1 - probability) quantile of the final SoC, to first order: as far
/// as the depletion is linear in power and voltages do not differ much between phases. Throws as
/// margin_percent does.
PlanningProblem mission_at_quantile(const PlanningProblem& problem, double probability);

}  // namespace flightwatt::mission
