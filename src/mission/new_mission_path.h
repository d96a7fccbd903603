#pragma once

#include "path/plan_files.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// The [path] of a new mission, made of a plan.
struct NewPath {
    std::vector<std::string> keys;  ///< lines of TOML, beyond the airspeed
    std::vector<std::string>
        chosen;  ///< what the plan leaves open: "spacing_m = 40, for turns with a bank of 30 degrees"
    std::optional<path::PlannedSpeed> speed = {};
};

/// Reads a plan of QGroundControl or ArduPilot, waypoints, `blocks` of Paparazzi's flight plan in the order of flight, or
/// an area of GeoJSON or KML. `name` is the file as the mission names it. Throws UsageError where blocks have to be
/// named, and InputError for a plan that cannot be read.
NewPath path_of_plan(const std::filesystem::path& file, const std::string& name, std::vector<std::string> blocks,
                     double airspeed_m_per_s, bool is_rotorcraft);

}  // namespace flightwatt::mission
