#pragma once

#include "mission/disturbance.h"
#include "mission/flight_replanner.h"
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

struct AdaptiveResult {
    Schedule schedule;  ///< that came about
    AdaptiveDecisions decisions;
};

/// Flies `actual`, the mission as it really is (other durations, battery, powers), under disturbances that the policy
/// does not know. At each decision it makes the best plan of the rest anew, from the state of charge reached, the RC
/// voltage (which charge, voltage and current tell), the part of the phase flown (an aircraft knows how much of its way
/// lies behind it), and the factor of mechanical power learned (docs/methods.md, Eqs. 33 and 34). Where no plan keeps
/// the reserve, and stays above the cut-off voltage, with its margin, what demands least energy is run; fixed segments
/// are kept in any case.
AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances);

}  // namespace flightwatt::mission
