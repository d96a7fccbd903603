#pragma once

#include "report/sections/section.h"
#include "report/simulated_mission.h"

#include <span>

namespace flightwatt::report {

/// The missions whose schedules were planned: what they are worth and what is proven of that, beside the
/// other missions with the same flight, software and battery, and what runs when. Without figures where none
/// was planned.
Section plan_section(std::span<const SimulatedMission> missions);

}  // namespace flightwatt::report
