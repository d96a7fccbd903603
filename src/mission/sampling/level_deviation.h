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
LevelDeviation level_deviation(const MissionSetup& mission, Phase phase);

/// The deviation [W] where it is how flights differ. Throws InputError where there is no mechanical model, or
/// one that does not say so.
double level_sd_w(const MissionSetup& mission, Phase phase);

/// Standard deviation [points] of a mission's depletion (docs/methods.md, Eq. 34), each phase flown beside the
/// configuration that draws most. Throws InputError as level_sd_w; NoAnswerError where the battery could not deliver
/// one standard deviation more of mechanical power.
double soc_depletion_sd_percent(const MissionSetup& mission, const std::vector<compute::Configuration>& configurations);

/// What to plan for above a reserve, so that it is kept with `probability`: that quantile of a Gaussian with the
/// deviation above. Throws std::invalid_argument for a probability not from 0.5 to below 1.
double margin_percent(const MissionSetup& mission, const std::vector<compute::Configuration>& configurations,
                      double probability);

/// The mission with mechanical power raised by what flights exceed with 1 - probability: every phase by its deviation
/// times its part in that of the energy, times the Gaussian quantile. Its final state of charge is, to first order,
/// the (1 - probability) quantile of the flights'. Throws as margin_percent does.
PlanningProblem mission_at_quantile(const PlanningProblem& problem, double probability);

}  // namespace flightwatt::mission
