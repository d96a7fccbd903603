#pragma once

#include "mission/simulation.h"

#include <vector>

namespace flightwatt::mission {

/// The mission with a schedule, no longer to be planned.
Mission with_schedule(const Mission& mission, std::vector<Stretch> schedule);

/// How far below `wanted_percent` a simulated mission ends [points], counting what it demanded after the
/// battery gave out as a part of what a full one holds. Negative if there is more.
double missing_percent(const Mission& mission, const MissionSummary& summary, double wanted_percent);

}  // namespace flightwatt::mission
