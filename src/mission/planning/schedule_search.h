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

/// Schedules of the first slots with nearly the same result: one of them, by its last run, and a state and a utility
/// that none of them exceeds.
struct StateLabel : RunStep {
    battery::BatteryState state;
    double utility = 0.0;
    double effective_percent = 0.0;
    double adjusted_percent = 0.0;  ///< the charge less what its RC voltage costs at least
    double bound = 0.0;             ///< nothing that begins so has more utility
    double priority = 0.0;          ///< where there is no room for all, those with the greatest are kept
};

/// What counts when labels of a slot are compared.
struct MergeWeights {
    double rc_low = 0.0;  ///< [points/V] as in UtilityBound
    double rc_high = 0.0;
    double rc_joined = 0.0;
    double utility_per_percent = 0.0;  ///< about
    double utility_tolerance = 0.0;    ///< a utility that counts for nothing
};

/// Removes dominated labels: another one has no less charge, neither adjusted by the least nor by the greatest cost of
/// its RC voltage (or no more RC voltage, where that may end a flight). Of the others, those that differ by a utility
/// of less than `tolerance` are merged into one that none of them exceeds. `labels` is in order of adjusted charge.
std::vector<StateLabel> merge_labels(const std::vector<StateLabel>& labels, const MergeWeights& weights,
                                     double tolerance);

/// Heuristic estimate of the utility that can follow, to rank labels where a late cut-off makes the upper bound too
/// loose. It may be too high or too low.
struct HeuristicValue {
    /// At a slot's start: from the least charge that may land up to that of the course of least power, in equal steps.
    struct AtSlot {
        double min_percent = 0.0;
        double step_percent = 1.0;
        std::vector<double> utility;  ///< minus infinity: does not land
    };
    std::vector<AtSlot> at;
};

/// By dynamic programming over `cells` of charge a slot, with the steady RC voltage of each choice and runs of minimum
/// duration.
HeuristicValue make_cautious_value(const ScheduleProblem& problem, const ScheduleGraph& graph,
                                   const UtilityBound& bounds, std::size_t cells);

double utility_to_go(const HeuristicValue& value, std::size_t slot, double soc_percent);

}  // namespace flightwatt::mission
