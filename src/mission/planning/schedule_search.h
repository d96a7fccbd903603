#pragma once

#include "mission/planning/schedule_value.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace flightwatt::mission {

/// How far to search.
struct SearchLimits {
    double relative_gap = 3e-5;      ///< between utility and bound, at which the search ends
    std::size_t max_labels = 20000;  ///< per slot; dropping more of them raises the bound
    std::size_t value_cells = 96;    ///< of the bound over charge (schedule_value.h)
};

struct FoundSchedule {
    std::vector<std::size_t> choices;  ///< one a slot
    double utility = -std::numeric_limits<double>::infinity();
    double end_percent = -std::numeric_limits<double>::infinity();  ///< infinite where the battery does not last
};

struct SearchResult {
    bool feasible = false;
    FoundSchedule best;  ///< if infeasible, the schedule of least energy demand
    double bound = 0.0;  ///< proven: nothing that lands with the reserve has more utility; 0 if infeasible
};

/// The schedule of greatest utility that keeps the reserve: label search (docs/methods.md) over charge, RC voltage and
/// utility, with the upper bound of schedule_value.h. Labels dropped to limit their number raise the bound, which holds
/// unless something charges the battery.
SearchResult search_schedule(const ScheduleProblem& problem, const SearchLimits& effort);

}  // namespace flightwatt::mission
