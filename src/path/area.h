#pragma once

#include "path/plan_files.h"

#include <string>
#include <string_view>

namespace flightwatt::path {

/// Plans lines over the polygon of a GeoJSON or KML file: `spacing_m` apart, on the course `heading_deg` and back, with
/// half circles between them. Throws InputError, placed in the file, unless it has one polygon, in which lines fit.
PlanEntries parse_area(std::string_view text, const std::string& file, double spacing_m, double heading_deg);

}  // namespace flightwatt::path
