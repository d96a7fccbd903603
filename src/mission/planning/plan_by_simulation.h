#pragma once

#include "mission/plan.h"

#include <optional>

namespace flightwatt::mission {

/// Plans a mission whose battery's source follows its charge, or may be cut off: what a slot drains then
/// depends on what ran before it. The table is made along the voltage of the last plan simulated, and planned
/// anew, with as much more reserve as the simulation fell short, until a plan lands and the next is no
/// better. The bound is that of the table along the highest voltage that any schedule keeps (see planner.h),
/// so it is proven though not always reached; where something charges it is not proven. If the schedule that
/// drains least does not land, none does, as it keeps the most charge and the highest voltage at any time.
///
/// With `probability`, all of this for a mission as of unlucky_mission.
MissionPlan plan_by_simulation(const Mission& mission, const std::optional<double>& probability);

/// The mission with mechanical power raised by what flights exceed with 1 - probability: every phase by its
/// deviation (level_sd_w) times its part in the deviation of the energy, times the Gaussian quantile. Its end
/// is that of the mission that the end falls below with that chance, as far as the drain is linear
/// in power and voltages do not differ much between phases. Throws as margin_percent does.
Mission unlucky_mission(const Mission& mission, double probability);

}  // namespace flightwatt::mission
