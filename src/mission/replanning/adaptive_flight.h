#pragma once

#include "mission/disturbance.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

namespace flightwatt::mission {

/// What a flight controller knows beforehand: the mission as it was stated, and how that depletes the battery.
struct AdaptivePlanner {
    PlanningProblem nominal;
    PlanningTables planner;
};

/// Throws as make_planning_tables does, and std::invalid_argument for a problem without a policy.
AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem);

struct AdaptiveResult {
    Schedule schedule;  ///< that came about
    AdaptiveDecisions decisions;
};

/// Flies `actual`, the mission as it really is (other durations, battery, powers), under disturbances that the policy
/// does not know. At each decision it makes the best plan of the rest anew, from the state of charge reached, the RC
/// voltage (which charge, voltage and current tell), the part of the phase flown (an aircraft knows how much of its way
/// lies behind it), and the factor of mechanical power learned (docs/methods.md, Eqs. 36 and 37). Where no plan keeps
/// the reserve, and stays above the cut-off voltage, with its margin, what demands least energy is run; fixed segments
/// are kept in any case.
AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances);

}  // namespace flightwatt::mission
