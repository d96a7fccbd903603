#include "mission/flown_schedule.h"

#include "base/units.h"

#include <algorithm>

namespace flightwatt::mission {

Mission with_schedule(const Mission& mission, std::vector<Stretch> schedule) {
    auto flown = mission;
    flown.schedule = std::move(schedule);
    flown.plan.reset();
    return flown;
}

double missing_percent(const Mission& mission, const MissionSummary& summary, double wanted_percent) {
    double missing = wanted_percent - summary.final_soc_percent.value_or(0.0);
    if (summary.feasible) return missing;
    // What is left after a cut-off cannot be drawn: it does not make up for what was demanded later.
    missing = std::max(missing, 0.0);
    return missing + units::percent_of(summary.energy_wh - summary.delivered_energy_wh,
                                       full_energy_wh(mission.battery));
}

}  // namespace flightwatt::mission
