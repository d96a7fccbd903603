#pragma once

#include "mission/plan.h"
#include "mission/planning/knapsack.h"
#include "mission/planning/planner.h"

#include <optional>

namespace flightwatt::mission {

/// Where a plan starts: before the flight, or in it.
struct PlanStart {
    double time_s = 0.0;  ///< of the mission
    double soc_percent = 100.0;
    /// For the dwell time; ignored if it is none of the planner's.
    std::optional<compute::Configuration> running = std::nullopt;
    double running_for_s = 0.0;
    double mechanical_factor = 1.0;  ///< of mechanical depletion to what the model predicts
};

/// The schedule of most utility of those that end with the reserve. Takes milliseconds, so that it can be
/// called anew in flight.
Plan plan_rest(const PlanningProblem& problem, const Planner& planner, const PlanStart& start,
               double reserve_soc_percent, const KnapsackEffort& effort = {});

}  // namespace flightwatt::mission
