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

/// Reads waypoints from KML: its LineStrings, without them its Points. Altitudes above the ground follow the tiles in
/// the folder of the settings, if they name one. Throws InputError.
PlanEntries parse_kml(std::string_view text, const std::string& file, const AutopilotSettings& settings = {});

/// Corners of a polygon on the ellipsoid.
using Outline = std::vector<GeodeticPosition>;

/// Polygons of an area file.
struct AreaOutlines {
    std::vector<Outline> areas;
    std::vector<Outline> closed;  ///< holes, and zones that are not flown over
    bool has_altitudes = false;   ///< other than 0, of areas
};

/// Reads the polygons of a GeoJSON file; those of a feature with the property "no_fly": true are closed. Throws
/// InputError, placed in the file, for anything else.
AreaOutlines geojson_area(std::string_view text, const std::string& file);

}  // namespace flightwatt::path
