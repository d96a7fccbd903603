#pragma once

#include "mission/planning/utility_bound.h"

#include <cstddef>
#include <limits>
#include <vector>

// Problem: one choice a slot, so that the utility is greatest and the battery lands with its reserve. What a choice
// draws depends on what ran before: the voltage falls with the charge, an RC pair remembers currents, and a cut-off may
// end the flight.
//
// State: slot, running choice, state of charge, RC voltage. Dwell times are runs of several slots (schedule_graph.h).
// The battery is integrated from state to state (slot_dynamics.h) without interpolation: a schedule found lands as it
// does in the simulation.
//
// Order of states: if nothing charges, more charge and less RC voltage are better at any later time, and two charges
// never approach each other (docs/methods.md). A state is dropped if another one of its slot has no less utility, and
// no less charge at both the least and the greatest cost of its RC voltage.
//
// Bound: from the landing backwards, the utility that may follow is at most a concave function of charge, whose slope
// is the Lagrangian price of charge (utility_bound.h). A state is dropped if that does not lead beyond the best
// schedule known. If too many are left, those of greatest bound and the best one of each cell of charge are kept; the
// result's bound is then no lower than that of the others.
//
// Passes with increasing numbers of states: the first ones find a good schedule, with which the later ones drop most
// states, and whose RC voltages make the bound tighter. A pass that leaves out none is exact up to `relative_gap`.
//
// Limits: no bound where something charges the battery. In long missions whose battery would be cut off late, the bound
// may be some percent too high, and the best schedule may not be found (docs/validation.md).

namespace flightwatt::mission {

/// How far to search.
struct SearchLimits {
    double relative_gap = 3e-5;      ///< between utility and bound, at which the search ends
    std::size_t max_states = 20000;  ///< per slot and choice; leaving out more of them raises the bound
    std::size_t bound_cells = 96;    ///< of charge, for the bound
};

struct FoundSchedule {
    std::vector<std::size_t> choices;  ///< one a slot
    double utility = -std::numeric_limits<double>::infinity();
    double end_percent = -std::numeric_limits<double>::infinity();  ///< infinite where the battery does not last
};

struct SearchResult {
    bool feasible = false;
    FoundSchedule best;  ///< if infeasible, the schedule of least energy demand
    double bound = 0.0;  ///< no schedule that lands with the reserve has more utility; 0 if infeasible
};

/// Returns the schedule of greatest utility found among those that keep the reserve, and an upper bound of all.
SearchResult search_schedule(const ScheduleProblem& problem, const SearchLimits& limits);

}  // namespace flightwatt::mission
