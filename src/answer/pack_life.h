#pragma once

#include "answer/pack_ledger.h"
#include "mission/prepared_mission.h"

#include <string>

namespace flightwatt::answer {

/// Until when a pack flies a mission and lands with its reserve in 95 of 100 flights, if its resistance and capacity
/// continue as their trends: "until 2026-11-02 (2026-09-12 to 2027-02-01)", the interval by that of the trends. A trend is
/// extended by at most the time that the flights show; where it is not significant, or the reserve is kept so long, "not
/// within what the flights show"; or the reason why that is unknown. The open-circuit voltage is the mission's battery's.
std::string mission_life(const Pack& pack, const mission::PreparedMission& mission);

}  // namespace flightwatt::answer
