#pragma once

#include "path/path_entries.h"

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace flightwatt::path {

using Json = nlohmann::json;

/// Throws InputError with the line of what is no JSON, and of a number that is out of range.
Json parse_json(std::string_view text, const std::string& file, const std::string& hint);

/// The outer boundary of an area.
struct Outline {
    std::vector<GeodeticPosition> corners;
    bool has_holes = false;
};

/// Of the only geometry of a GeoJSON file, a Polygon. Throws InputError, placed in the file, for anything else.
Outline geojson_outline(std::string_view text, const std::string& file);

}  // namespace flightwatt::path
