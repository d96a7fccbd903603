#pragma once

#include "path/plan_files.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::path {

/// Formats of plans, which the beginning of a text shows; GeoJSON and KML begin as two of them.
enum class PlanFormat { none, flight_plan, qgroundcontrol, ardupilot };

/// Returns the format of a text by its beginning.
PlanFormat plan_format(std::string_view text);

/// Reads every block of a plan in any of the formats. A block that cannot be read has the reason in `not_flown`. Throws
/// InputError, placed in the file, for a file that cannot be read.
std::vector<PlanBlock> parse_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings);

/// Reads blocks of a Paparazzi flight plan as one path, in metres from its lat0 and lon0, altitudes above the sea.
/// Patterns without an end are flown once; loops, exceptions and calls of unknown functions are not flown. Throws
/// InputError, placed in the file, for an unknown block or waypoint and for a radius that is not known.
PlanEntries parse_plan_blocks(std::string_view text, const std::string& file, const std::vector<std::string>& blocks,
                              const AutopilotSettings& settings);

/// Returns lat0 and lon0 of a Paparazzi flight plan, the origin of its places, and the altitude of its ground.
std::pair<GeodeticPosition, std::optional<double>> flight_plan_origin(std::string_view text, const std::string& file);

/// Reads waypoints of a Paparazzi flight plan, in the order of the names. Throws as parse_plan_blocks.
std::vector<PathEntry> parse_flight_plan(std::string_view text, const std::string& file,
                                         const std::vector<std::string>& names);

}  // namespace flightwatt::path
