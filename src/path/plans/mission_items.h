#pragma once

#include "base/error.h"
#include "path/plan_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::path {

// MAV_CMD
inline constexpr int nav_waypoint = 16, nav_loiter_unlimited = 17, nav_loiter_turns = 18, nav_loiter_time = 19,
                     nav_return = 20, nav_land = 21, nav_takeoff = 22, nav_loiter_to_altitude = 31, nav_spline = 82,
                     nav_vtol_takeoff = 84, nav_vtol_land = 85, nav_delay = 93, jump = 177, change_speed = 178,
                     vtol_transition = 3000, condition_gate = 4501;

/// Returns whether a command that is not known moves the aircraft: those for navigation, and few others.
inline bool is_movement(int command) {
    constexpr int last_for_navigation = 94;
    constexpr int region_of_interest = 80;
    constexpr int first_of_user = 31000, last_of_user = 31004;                          // waypoints of a user's own
    constexpr std::array others{0, 113, 179, 192, 213, 252, 601, 30001, 42702, 42703};  // 0: an item without commands
    return std::ranges::count(others, command) > 0 || (command >= first_of_user && command <= last_of_user) ||
           (command >= nav_waypoint && command <= last_for_navigation && command != region_of_interest);
}

/// Returns that a command is not flown, and of those of a camera or its mount that nothing moves.
inline std::string unflown_text(int command) {
    constexpr std::array of_camera{195, 196, 197, 200,  201,  202,  203,  204,  205, 206,
                                   530, 531, 532, 1000, 1001, 2000, 2001, 2500, 2501};
    if (command == 0) return "not flown";
    if (std::ranges::count(of_camera, command) > 0)
        return "command " + std::to_string(command) + " works the camera, and moves nothing";
    return "command " + std::to_string(command) + " is not flown";
}

/// Returns whether a command is a take-off or a landing of VTOLs.
inline bool is_of_vtol(int command) { return command == nav_vtol_takeoff || command == nav_vtol_land; }

/// A command of MAVLink (MAV_CMD) with its frame (MAV_FRAME) and parameters; NaN for those that are not given.
struct MissionItem {
    int command = 0;  ///< 0: without one
    int frame = 0;
    std::array<double, 7> parameters = {};
    std::string name;
    Location where;
    double number = -1.0;  ///< by which jumps name it, 0 or more
};

/// The items of a plan, and what it states of its vehicle.
struct MissionItems {
    std::array<double, 3> home{std::nan(""), std::nan(""), std::nan("")};  ///< latitude, longitude, altitude above sea
    std::vector<MissionItem> items;
    Location where;
    std::optional<PlannedSpeed> speed = {};
    bool is_of_px4 = false;
    bool is_of_ardupilot = false;
    bool has_rally_points = false;
    std::optional<bool> is_of_multirotor = {};  ///< by the kind of vehicle that the plan names
    bool is_of_vtol = false;                    ///< likewise, or by its commands
    bool is_of_another_vehicle = false;         ///< likewise: neither of a wing, a multirotor nor a VTOL
};

}  // namespace flightwatt::path
