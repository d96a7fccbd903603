#pragma once

#include "mission/planning/knapsack.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// Where a plan begins: before the flight, or in it.
struct PlanStart {
    double time_s = 0.0;  ///< of the mission
    double soc_percent = 100.0;
    std::optional<compute::Configuration>
        running;  ///< for the dwell time; ignored if it is none of the planner's
    double running_for_s = 0.0;
    double mechanical_factor = 1.0;  ///< of what mechanical power drains, to what the model foresees
};

/// A schedule for the rest of a mission, by the planner's tables.
struct Plan {
    bool feasible = false;
    bool deliverable = false;       ///< the battery can deliver the power of some schedule
    std::vector<Stretch> schedule;  ///< from the start to the mission's end; if infeasible, what drains least
    double utility = 0.0;           ///< mean worth a second of the rest of the mission
    double bound = 0.0;             ///< no schedule that keeps the reserve is worth more; 0 if infeasible
    bool bound_is_proven = true;    ///< false: what charges a battery whose source follows its charge
    double final_soc_percent = 0.0;  ///< as if the battery went on below empty
};

/// The schedule that is worth most of those that end with the reserve. Takes milliseconds, so that it can be
/// called anew in flight.
Plan plan_rest(const Mission& mission, const Planner& planner, const PlanStart& start,
               double reserve_soc_percent, const SlotChoiceEffort& effort = {});

/// A plan of a whole mission that Runge-Kutta has flown.
struct MissionPlan {
    Plan plan;                    ///< its bound is of the tables, whatever Runge-Kutta says
    Mission flown;                ///< the mission with the plan's schedule, no longer to be planned
    MissionSummary summary;       ///< of that, simulated
    double margin_percent = 0.0;  ///< kept above the reserve for the sake of the probability
    Planner planner;              ///< whose table holds along the plan: for plans made anew in flight
};

/// Plans a mission and simulates the result; where that ends below the reserve (by rounding, or because a
/// full battery refused charge, which tables do not know), plans anew with more to spare. The tables drain no
/// more than the simulation, so the bound holds nevertheless. With `probability`, the reserve is kept
/// with that chance: see drain_spread.h. Infeasible plans are returned as such. Batteries whose source
/// follows their charge, and those that may be cut off: see simulated_plan.h.
MissionPlan plan_mission(const Mission& mission, const std::optional<double>& probability = std::nullopt);

/// What the flown mission comes to, labelled as optimal (its bound is within 0.1 %) or planned.
MissionSummary labelled_summary(const MissionPlan& plan);

}  // namespace flightwatt::mission
