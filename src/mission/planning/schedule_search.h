#pragma once

#include "mission/planning/schedule_value.h"

namespace flightwatt::mission {

/// The schedule of greatest utility that keeps the reserve, where depletion depends on the battery's state: label
/// search (docs/methods.md) over charge, RC voltage and utility, with the upper bound of schedule_value.h. Labels
/// dropped to limit their number raise the bound, which holds unless something charges the battery. `cost` is the
/// charge used; if infeasible, that of the schedule of least energy demand, infinite where the battery does not last.
KnapsackSolution search_schedule(const ScheduleProblem& question, const SearchLimits& effort);

}  // namespace flightwatt::mission
