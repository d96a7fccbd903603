#pragma once

#include "path/path_entries.h"
#include "path/plan_files.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

/// Reads the waypoints of a file, in its order: GeoJSON by its ending (.geojson, .json), plans of QGroundControl and
/// ArduPilot and KML by their content, else CSV (docs/formats.md, Waypoints). Throws InputError, placed in the file.
PlanEntries read_waypoints(const std::filesystem::path& path, const AutopilotSettings& settings);

/// Reads waypoints from CSV. Throws InputError, placed in the file.
std::vector<PathEntry> parse_waypoint_csv(std::string_view text, const std::string& file);

/// Reads waypoints from GeoJSON: Points and LineStrings. Throws InputError, placed in the file.
std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file);

/// Reads waypoints from KML, level: its LineStrings, without them its Points. Throws InputError.
PlanEntries parse_kml(std::string_view text, const std::string& file);

/// The outer boundary of an area.
struct Outline {
    std::vector<GeodeticPosition> corners;
    bool has_holes = false;
};

/// Reads the outline of the only geometry of a GeoJSON file, a Polygon. Throws InputError, placed in the file, for
/// anything else.
Outline geojson_outline(std::string_view text, const std::string& file);

}  // namespace flightwatt::path
