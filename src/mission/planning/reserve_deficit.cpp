#include "mission/planning/reserve_deficit.h"

#include "base/units.h"

#include <algorithm>

namespace flightwatt::mission {

double reserve_deficit_percent(const MissionSetup& mission, const MissionSummary& summary,
                               double wanted_percent) {
    const double deficit = wanted_percent - summary.final_soc_percent.value_or(0.0);
    if (summary.feasible) return deficit;
    // What is left after a cut-off cannot be drawn: it does not make up for what was demanded later.
    return std::max(deficit, 0.0) + units::percent_of(summary.energy_wh - summary.delivered_energy_wh,
                                                      full_energy_wh(mission.battery));
}

}  // namespace flightwatt::mission
