#pragma once

#include "path/plan_files.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

/// The waypoints of a file, in its order: GeoJSON by its ending (.geojson, .json), plans of QGroundControl and
/// ArduPilot by their content, else CSV (docs/formats.md, Waypoints). Throws InputError, placed in the file.
PlanEntries read_waypoints(const std::filesystem::path& path, const AutopilotSettings& settings);

/// CSV and GeoJSON from text.
std::vector<PathEntry> parse_waypoint_csv(std::string_view text, const std::string& file);
std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file);

}  // namespace flightwatt::path
