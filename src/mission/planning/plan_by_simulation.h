#pragma once

#include "mission/plan.h"

#include <optional>

namespace flightwatt::mission {

/// Plans a mission whose battery's source follows its charge, or may be cut off: the depletion by a slot
/// then depends on what ran before it. The table is made along the voltage of the last plan simulated, and planned
/// anew, with as much more reserve as the simulation fell short, until a plan lands and the next is no
/// better. The bound is that of the table along the highest voltage that any schedule keeps (see planner.h),
/// so it is proven though not always reached; where something charges it is not proven. If the schedule
/// of least energy demand does not land, none does, as it keeps the most charge and the highest voltage at any time.
///
/// If `probability` is given, plans for the mission at that quantile of mechanical power.
MissionPlan plan_by_simulation(const PlanningProblem& problem, const std::optional<double>& probability);

/// The mission with mechanical power raised by what flights exceed with 1 - probability: every phase by its
/// deviation (level_deviation) times its part in the deviation of the energy, times the Gaussian quantile. The
/// final SoC of the returned mission is the (1 - probability) quantile of the final SoC, to first order: as far
/// as the depletion is linear in power and voltages do not differ much between phases. Throws as
/// margin_percent does.
PlanningProblem mission_at_quantile(const PlanningProblem& problem, double probability);

}  // namespace flightwatt::mission
