#pragma once

#include "mission/planning/schedule_value.h"

namespace flightwatt::mission {

/// The schedule of most utility that lands with the reserve, where what a slot takes depends on the battery's state.
/// Labels (state of charge, RC voltage, utility; with a dwell time also the choice that runs) are carried from slot to
/// slot as the battery follows them, without those that another one dominates, whose upper bound (schedule_value.h)
/// says that they cannot win, and those that are cut off. What is dropped for want of room raises the bound, which
/// holds in any case if nothing charges. The solution's cost is the charge that the schedule takes; if infeasible, it
/// is the one of least energy demand, and its cost infinite where the battery does not last.
KnapsackSolution search_schedule(const ScheduleProblem& question, const SearchLimits& effort);

}  // namespace flightwatt::mission
