#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"
#include "mission/sampling/joint_spread.h"

#include <vector>

namespace flightwatt::mission {

/// Half the width of a normal 95 % interval, in deviations.
inline constexpr double sd_per_half_95 = 1.96;

/// How the power of one component differs between flights.
struct ComponentSpread {
    double common_sd_percent = 0.0;  ///< of all its nodes together
    std::vector<double> node_sd_w;   ///< of each by itself; or empty
};

/// What differs between the flights of a mission: the one definition of it, for plans that keep a reserve with a
/// chance and for flights that are drawn. What is not in it is the same in every flight: initial charge, schedule,
/// cut-off voltage, and the course of the power within a flight beside its phases' levels.
struct FlightUncertainty {
    PerPhase<double> level_sd_w;  ///< of a phase's mean mechanical power
    PerPhase<double> duration_sd_s;
    std::vector<JointDistribution> of_flights;  ///< those of them that few flights show, and not the mission states
    std::vector<ComponentSpread> components;    ///< one a component of the mission
    battery::BatteryIntervals battery;          ///< 95 % intervals of what differs
    UncertaintySources sources;
};

/// What the mission's [uncertainty] states, which is normal. Else: levels as level_deviation says; durations as the
/// model's flights show, in proportion, with the same factor for a flight to come, unless the mission states the
/// duration; both by Student's t, together as they were in the flights; computing by the standard errors of the
/// profile's nodes; the battery by the 95 % intervals of its file, but not a capacity that the mission states.
FlightUncertainty collect_uncertainty(const MissionSetup& mission);

}  // namespace flightwatt::mission
