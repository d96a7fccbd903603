#pragma once

#include "path/plan_files.h"

#include <string>
#include <string_view>

namespace flightwatt::path {

/// Plans lines over the polygons of a GeoJSON or KML file: `spacing_m` apart, on the course `heading_deg` and back, with
/// half circles between them, around holes and polygons that are not to be flown over (docs/missions.md). Throws
/// InputError, placed in the file, for an area without lines, or one that these zones enclose.
PlanEntries parse_area(std::string_view text, const std::string& file, double spacing_m, double heading_deg);

}  // namespace flightwatt::path
