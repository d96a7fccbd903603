#pragma once

#include "mission/mission.h"
#include "mission/sampling/student.h"

#include <cstddef>

namespace flightwatt::mission {

/// What says how the mean mechanical power of a phase differs between flights.
enum class DeviationSource {
    none,
    stated,      ///< the mission's [uncertainty]
    conditions,  ///< the flights about what the mission's [conditions] say
    path,        ///< the flights about what their motion says
    flights,     ///< the model's flights about their average
    fit_error    ///< the standard error of the fit alone, which is not how flights differ
};

/// Standard deviation of a phase's mean mechanical power about the model's, of a flight to come.
struct MeanPowerDeviation {
    double sd_w = 0.0;
    DeviationSource source = DeviationSource::none;
    std::size_t flights = 0;  ///< that it is of, if of the model's
    /// Of the Student t that the level of a flight to come is, in units of sd_w; infinite: it is normal.
    double degrees_of_freedom = infinite_dof;
};

/// The first of the sources, in their order, that the mission has. Of the model's flights: their standard
/// deviation times sqrt(1 + sum of their squared weights), which is that of a new flight about an average of
/// few; estimated from so few, it goes with Student's t. Needs a mechanical model.
MeanPowerDeviation level_deviation(const MissionSetup& mission, Phase phase);

/// The mean mechanical power [W] of a phase, as the mission has it. Needs a mechanical model.
double mean_level_w(const MissionSetup& mission, Phase phase);

/// Whether the mission says of each phase that is flown how flights differ.
bool has_flight_variability(const MissionSetup& mission);

/// The deviation [W] where it is how flights differ. Throws InputError where the model does not say so. Needs one too.
double level_sd_w(const MissionSetup& mission, Phase phase);

/// Throws InputError where the mechanical model does not say of each phase that is flown how flights differ: a chance
/// without that would be a promise about nothing.
void require_flight_variability(const MissionSetup& mission);

}  // namespace flightwatt::mission
