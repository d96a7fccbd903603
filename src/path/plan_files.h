#pragma once

#include "path/path_entries.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

/// Values that a plan leaves to the autopilot's settings.
struct AutopilotSettings {
    std::optional<double> radius_m;  ///< of circles for which the plan states none
    double airspeed_m_per_s = 0.0;   ///< for circles that end after a time; 0: they are flown once
};

/// The movements of a plan, in the order of the flight.
struct PlanEntries {
    std::vector<PathEntry> entries;
    std::vector<std::string> not_flown = {};  ///< "line 80: the circle around STDBY has no end: it is flown once"
    bool starts_at_first_place = false;       ///< as PathDefaults
};

/// A block of a flight plan, read on its own; or the whole mission of another plan.
struct PlanBlock {
    std::string name;
    std::size_t line = 0;    ///< 0: unknown
    std::string flown = {};  ///< "5 legs, 1.5 circles"; empty if nothing is
    double length_m = 0.0;
    std::vector<std::string> not_flown = {};
};

/// Formats of plans, by how a text begins; GeoJSON and KML begin as two of them.
enum class PlanFormat { none, flight_plan, qgroundcontrol, ardupilot };
PlanFormat plan_format(std::string_view text);

/// Every block of a plan in any of the formats. A block that cannot be read has the reason in `not_flown`. Throws
/// InputError, placed in the file, for a file that cannot be read.
std::vector<PlanBlock> parse_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Blocks of a Paparazzi flight plan, one after the other, in metres from its lat0 and lon0, altitudes above the sea.
/// Patterns without an end are flown once; loops, exceptions and calls of unknown functions are not flown. Throws
/// InputError, placed in the file, for an unknown block or waypoint and for a radius that is not known.
PlanEntries parse_plan_blocks(std::string_view text, const std::string& file, const std::vector<std::string>& blocks,
                              const AutopilotSettings& settings);

/// Waypoints of a Paparazzi flight plan, in the order of the names. Throws as parse_plan_blocks.
std::vector<PathEntry> parse_flight_plan(std::string_view text, const std::string& file,
                                         const std::vector<std::string>& names);

/// The items of a plan of QGroundControl (.plan, version 1, mission version 2) or ArduPilot (.waypoints, "QGC WPL 110"),
/// altitudes above home. Unknown commands and jumps are not flown. Throws InputError, placed in the file.
PlanEntries parse_qgc_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);
PlanEntries parse_wpl(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Lines over the polygon of a GeoJSON or KML file: `spacing_m` apart, on the course `heading_deg` and back, with half
/// circles between them. Throws InputError, placed in the file, unless it has one polygon, into which lines fit.
PlanEntries parse_area(std::string_view text, const std::string& file, double spacing_m, double heading_deg);

/// The waypoints of a file, in its order: GeoJSON by its ending (.geojson, .json), plans of QGroundControl and
/// ArduPilot by their content, else CSV (docs/formats.md, Waypoints). Throws InputError, placed in the file.
PlanEntries read_waypoints(const std::filesystem::path& path, const AutopilotSettings& settings);

/// CSV and GeoJSON from text.
std::vector<PathEntry> parse_waypoint_csv(std::string_view text, const std::string& file);
std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file);

}  // namespace flightwatt::path
