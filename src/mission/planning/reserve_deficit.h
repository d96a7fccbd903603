#pragma once

#include "mission/simulation.h"

namespace flightwatt::mission {

/// How far below `wanted_percent` a simulated mission ends [points], counting what it demanded after the
/// battery ended as a part of what a full one holds. Negative if there is more.
double reserve_deficit_percent(const MissionSetup& mission, const MissionSummary& summary,
                               double wanted_percent);

}  // namespace flightwatt::mission
