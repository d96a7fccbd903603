#pragma once

#include "path/plan_files.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// The [path] of a new mission, made of a plan.
struct NewPath {
    std::vector<std::string> keys;    ///< lines of TOML, beyond the airspeed
    std::vector<std::string> chosen;  ///< what the plan leaves open: "heading_deg = 40, for the fewest turns"
    std::optional<path::PlannedSpeed> speed = {};
    std::set<double> own_m_per_s = {};  ///< airspeeds that its movements state
    bool lands = false;                 ///< at its end, where it is
};

/// What a new mission flies: a plan of QGroundControl or ArduPilot, waypoints, blocks of Paparazzi's flight plan, or an
/// area of GeoJSON or KML.
struct PlanToFly {
    std::filesystem::path file;
    std::string name;                                 ///< of the file, as the mission names it
    std::vector<std::string> blocks = {};             ///< in the order of flight
    std::optional<double> airspeed_m_per_s = {};      ///< default: the plan's, or that of the model's flights
    std::optional<double> spacing_m = {};             ///< of the lines over an area; default: of turns or of a camera
    std::optional<double> swath_m = {};               ///< width of ground that the camera sees
    std::optional<double> overlap_percent = {};       ///< of images of neighbouring lines; decides the spacing
    std::optional<double> heading_deg = {};           ///< of these lines; default: with the fewest turns
    std::optional<std::string> terrain = {};          ///< folder of tiles, for altitudes above the terrain
    std::string terrain_name = {};                    ///< of the folder, as the mission names it
    std::optional<path::GeodeticPosition> home = {};  ///< where it begins and ends; default: the first place
};

/// Whether a plan is an area, which is covered by lines.
bool is_area(const std::filesystem::path& file);

/// Reads a plan. Throws UsageError where blocks have to be named, or lines are stated for a plan that is no area, and
/// InputError for a plan that cannot be read.
NewPath path_of_plan(const PlanToFly& plan, double airspeed_m_per_s, bool is_rotorcraft);

}  // namespace flightwatt::mission
