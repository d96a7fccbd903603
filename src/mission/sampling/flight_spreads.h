#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"
#include "mission/sampling/joint_spread.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// What says how the mean mechanical power of a phase differs between flights.
enum class DeviationSource {
    none,
    stated,    ///< the mission's [uncertainty]
    motion,    ///< the flights about what their motion says
    flights,   ///< the model's flights about their average
    fit_error  ///< the standard error of the fit alone, which is not how flights differ
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

/// How the power of one component differs between flights.
struct ComponentSpread {
    double common_sd_percent = 0.0;  ///< of all its nodes together
    std::vector<double> node_sd_w;   ///< of each by itself; or empty
};

/// What differs between the flights of a mission: the one definition of it, for plans that keep a reserve with a
/// chance and for flights that are drawn. What is not in it is the same in every flight: schedule, cut-off voltage,
/// and the course of the power within a flight beside its phases' levels.
struct FlightUncertainty {
    PerPhase<double> level_sd_w;  ///< of a phase's mean mechanical power
    PerPhase<double> duration_sd_s;
    std::vector<JointDistribution> of_flights;  ///< those of them that few flights show, and not the mission states
    PerPhase<double> max_rise_w;                ///< a level is drawn no further above the mission's
    std::vector<ComponentSpread> components;    ///< one a component of the mission
    battery::BatteryIntervals battery;          ///< 95 % intervals of what differs
    UncertaintySources sources;
};

/// The highest power [W] that a flight of the model had in any phase, by its curve or on average; infinite where the
/// model keeps neither.
double highest_measured_power_w(const mechanical::MechanicalModel& model);

/// An aircraft draws a quarter more than it was measured to, at most: so far levels are drawn.
inline constexpr double power_margin = 1.25;

/// What the mission's [uncertainty] states, which is normal. Else: levels as level_deviation says; durations as the
/// model's flights show, in proportion, with the same factor for a flight to come, unless the mission states the
/// duration; both by Student's t, together as they were in the flights; computing by the standard errors of the
/// profile's nodes; the battery by the 95 % intervals of its file, but not a capacity that the mission states.
FlightUncertainty collect_uncertainty(const MissionSetup& mission);

}  // namespace flightwatt::mission
