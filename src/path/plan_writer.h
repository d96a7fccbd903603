#pragma once

#include "path/path.h"
#include "path/plan_blocks.h"
#include "path/turns.h"

#include <string>
#include <vector>

namespace flightwatt::path {

/// A flight that is written as a plan: take-off at the start of the path, the path, landing at its end.
struct PlanToWrite {
    std::string name;
    FlightPath path;  ///< without turns
    PathOrigin origin;
    bool is_rotorcraft = false;
    TurnLimits turns = {};  ///< turns between lines that are narrower, in the wind, are left to the autopilot
    Wind wind = {};
    ClimbRates rates = {};    ///< with which heights above one place change: that takes no hold
    bool is_of_vtol = false;  ///< take-off and landing are those of VTOLs
};

/// A plan in the format of a ground station.
struct WrittenPlan {
    std::string text;
    std::vector<std::string> notes;  ///< what is a default of the format, or is not written
};

/// Altitude above the ground that is written for a path without one, QGroundControl's default.
inline constexpr double default_altitude_m = 50.0;

/// Name of the block with the path in a flight plan of Paparazzi.
inline constexpr auto written_block = "Flight";

/// Returns the ending of the names of files in a format, such as ".plan".
std::string plan_ending(PlanFormat format);

/// Writes a flight in a format other than `none`, so that its readers (read_waypoints, parse_plan_blocks) give the same
/// path. Climb rates are not written, and times of ways that were measured neither.
WrittenPlan write_plan(const PlanToWrite& plan, PlanFormat format);

}  // namespace flightwatt::path
