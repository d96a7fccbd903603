#pragma once

#include "path/path_entries.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

/// The waypoints of a file, in its order: GeoJSON by its ending (.geojson, .json), else CSV (docs/formats.md,
/// Waypoints). Throws InputError, placed in the file.
std::vector<PathEntry> read_waypoints(const std::filesystem::path& path);

/// The same from text.
std::vector<PathEntry> parse_waypoint_csv(std::string_view text, const std::string& file);
std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file);

/// The named waypoints of a Paparazzi flight plan, in the order of the names, as places in metres from the plan's lat0
/// and lon0 with altitudes above the sea. Its blocks are a program, which is not run. Throws InputError, placed in the
/// file, for a name that it does not have.
std::vector<PathEntry> read_flight_plan(const std::filesystem::path& path, const std::vector<std::string>& names);
std::vector<PathEntry> parse_flight_plan(std::string_view text, const std::string& file,
                                         const std::vector<std::string>& names);

}  // namespace flightwatt::path
