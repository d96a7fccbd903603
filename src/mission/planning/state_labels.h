#pragma once

#include "mission/planning/schedule_value.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// Schedules of the first slots that leave nearly the same: one of them by its last run, and a state and a utility that
/// none of them is better than.
struct StateLabel : RunStep {
    battery::BatteryState state;
    double utility = 0.0;
    EffectiveCharge charge = {};
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

/// Labels, given in the order of their weighed charge, without those that another one is as good as: that has as much
/// charge and, with RC voltage weighed by what it may cost at most, as much again; or no more RC voltage, where that
/// may end a flight. Of the others, those that differ by less than `tolerance`, a utility, become one that none of them
/// is better than.
std::vector<StateLabel> merge_labels(const std::vector<StateLabel>& labels, const MergeWeights& weights,
                                     double tolerance);

/// About what utility can still follow, where a bound promises too much: before a cut-off that comes late, bounds like
/// best the schedules that save their charge for what the voltage will not allow. Neither a bound nor a promise.
struct HeuristicValue {
    /// At a slot's start: from the least charge that may land up to that of the course of least power, in equal steps.
    struct AtSlot {
        double min_percent = 0.0;
        double step_percent = 1.0;
        std::vector<double> utility;  ///< minus infinity: does not land
    };
    std::vector<AtSlot> at;
};

/// By dynamic programming over `cells` of charge a slot, as if the RC voltage stood above that of the course of least
/// power by what the choice that begins makes of it in the end, and every run lasted no longer than it must.
HeuristicValue make_cautious_value(const ScheduleProblem& question, const KnapsackGraph& graph,
                                   const UtilityBound& bounds, std::size_t cells);

double utility_to_go(const HeuristicValue& value, std::size_t slot, double soc_percent);

}  // namespace flightwatt::mission
