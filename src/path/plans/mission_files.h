#pragma once

#include "path/plan_files.h"

#include <string>
#include <string_view>

namespace flightwatt::path {

// MAV_CMD
inline constexpr int nav_waypoint = 16, nav_loiter_unlimited = 17, nav_loiter_turns = 18, nav_loiter_time = 19,
                     nav_return = 20, nav_land = 21, nav_takeoff = 22, nav_loiter_to_altitude = 31, nav_spline = 82,
                     nav_vtol_takeoff = 84, nav_vtol_land = 85, nav_delay = 93, jump = 177, change_speed = 178,
                     vtol_transition = 3000;

/// Reads the items of a plan of QGroundControl (.plan, version 1, mission version 2), with altitudes above home.
/// Unknown commands and jumps are not flown. Throws InputError, placed in the file.
PlanEntries parse_qgc_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Reads the items of a plan of ArduPilot (.waypoints, "QGC WPL 110") likewise.
PlanEntries parse_wpl(std::string_view text, const std::string& file, const AutopilotSettings& settings);

}  // namespace flightwatt::path
