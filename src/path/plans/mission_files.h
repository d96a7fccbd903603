#pragma once

#include "path/plan_files.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace flightwatt::path {

// MAV_CMD
inline constexpr int nav_waypoint = 16, nav_loiter_unlimited = 17, nav_loiter_turns = 18, nav_loiter_time = 19,
                     nav_return = 20, nav_land = 21, nav_takeoff = 22, nav_loiter_to_altitude = 31, nav_spline = 82,
                     nav_vtol_takeoff = 84, nav_vtol_land = 85, nav_delay = 93, jump = 177, change_speed = 178,
                     vtol_transition = 3000;

/// Returns whether a command that is not known moves the aircraft: those for navigation, and few others.
inline bool is_movement(int command) {
    constexpr int last_for_navigation = 94;
    constexpr int region_of_interest = 80;
    constexpr std::array others{0, 113, 179, 192, 213, 252, 601, 42702, 42703};  // 0: an item without commands
    return std::ranges::count(others, command) > 0 ||
           (command >= nav_waypoint && command <= last_for_navigation && command != region_of_interest);
}

/// Reads the items of a plan of QGroundControl (.plan, version 1, mission version 2), with altitudes above home.
/// Unknown commands and jumps are not flown. Throws InputError, placed in the file.
PlanEntries parse_qgc_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Reads the items of a plan of ArduPilot (.waypoints, "QGC WPL 110") likewise.
PlanEntries parse_wpl(std::string_view text, const std::string& file, const AutopilotSettings& settings);

}  // namespace flightwatt::path
