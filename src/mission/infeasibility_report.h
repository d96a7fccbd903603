#pragma once

#include "mission/feasibility_limits.h"
#include "mission/plan.h"

#include <optional>
#include <string>

namespace flightwatt::mission {

/// By how much a mission that no schedule lands with its reserve misses it, and what would mend that, each
/// measure on its own; a measure that alone is not enough is none.
struct InfeasibilityReport {
    double short_percent = 0.0;                 ///< of the schedule that demands least energy
    double short_wh = 0.0;                      ///< the same, as a part of what a full battery holds
    std::optional<double> cut_off_at_s;         ///< short is then also what is demanded after the cut-off
    std::optional<double> cruise_s;             ///< the longest that lands
    std::optional<double> fixed_spare_percent;  ///< over the reserve, with the least where quality is fixed
    std::optional<double> reserve_soc_percent;  ///< the greatest that can be kept
    std::optional<double> capacity_ah;          ///< the least that suffices
};

/// `plan` is infeasible, of the mission that `mission_of` gives for the cruise as it is.
InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionOfCruise& mission_of);

/// For people: "short by 2.1 points (0.23 Wh); ...".
std::string describe(const MissionSetup& mission, const InfeasibilityReport& report);

}  // namespace flightwatt::mission
