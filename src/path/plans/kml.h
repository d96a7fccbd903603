#pragma once

#include "path/path_entries.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace flightwatt::path {

/// A place of a KML file, with the altitude that it states.
struct KmlPlace {
    GeodeticPosition place;
    std::optional<double> altitude_m;
};

/// Parses a file as XML. Throws InputError with the hint.
pugi::xml_document load_kml(std::string_view text, const std::string& file, const char* hint);

/// Returns the places in <coordinates>, "longitude,latitude[,altitude] ...". Throws InputError for others.
std::vector<KmlPlace> kml_places(const pugi::xml_node& coordinates, const std::string& file);

}  // namespace flightwatt::path
