#pragma once

#include "path/plan_files.h"
#include "path/plans/mission_items.h"

#include <string>
#include <string_view>

namespace flightwatt::path {

/// Reads the items of a plan of QGroundControl (.plan, version 1, mission version 2), with altitudes above home.
/// Unknown commands and jumps are not flown. Throws InputError, placed in the file.
PlanEntries parse_qgc_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Reads the items of a plan of ArduPilot (.waypoints, "QGC WPL 110") likewise.
PlanEntries parse_wpl(std::string_view text, const std::string& file, const AutopilotSettings& settings);

}  // namespace flightwatt::path
