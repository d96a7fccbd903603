#pragma once

#include "mission/replanning/adaptive_flight.h"
#include "mission/simulation.h"

#include <optional>

namespace flightwatt::mission {

/// A mission with all that is decided before take-off.
struct PreparedMission {
    MissionSetup setup;
    Schedule schedule;                        ///< empty if a policy makes it in flight
    std::optional<AdaptivePlanner> adaptive;  ///< such a policy
    ScheduleOrigin origin = ScheduleOrigin::given;
};

/// Plans a mission that is yet to be planned; of an adaptive one, prepares the plans. Throws as plan_mission.
PreparedMission prepare_mission(const MissionVariant& mission);

/// The schedule that was flown, and what came of it.
struct SimulatedFlight {
    Schedule schedule;
    Simulation simulation;
};

/// Flies a mission, under disturbances that nobody knew of beforehand.
SimulatedFlight simulate_prepared(const PreparedMission& prepared, const SimulationOptions& steps = {},
                                  const Disturbances& disturbances = {});

}  // namespace flightwatt::mission
