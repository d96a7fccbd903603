#pragma once

#include "mission/replanning/adaptive_flight.h"
#include "mission/simulation.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// A mission with all that is decided before take-off.
struct Flyable {
    Mission mission;                          ///< with its schedule, unless a policy makes that in flight
    std::optional<AdaptivePlanner> adaptive;  ///< such a policy
    std::string schedule;                     ///< how it came about, if the mission did not give it
    bool planned_feasibly = true;
};

/// Plans a mission that is yet to be planned; of an adaptive one, prepares the plans. Throws as make_planner.
Flyable make_flyable(const Mission& mission);

/// A flight and the schedule that it flew.
struct FlownMission {
    Mission flown;
    Simulation simulation;
};

/// Flies a mission, under disturbances that nobody knew of beforehand.
FlownMission fly(const Flyable& flyable, const SimulationSteps& steps = {},
                 const std::vector<Disturbance>& disturbances = {});

}  // namespace flightwatt::mission
