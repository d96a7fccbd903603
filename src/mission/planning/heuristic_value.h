#pragma once

#include "mission/planning/schedule_value.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

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
