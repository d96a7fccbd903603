#pragma once

#include "path/path_entries.h"

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace flightwatt::path {

/// Places of a KML file, in its order.
struct KmlPlaces {
    std::vector<GeodeticPosition> places;
    bool has_altitudes = false;  ///< any that is not 0
    bool is_level = true;        ///< all are the same
};

/// Parses a file as XML. Throws InputError with the hint.
pugi::xml_document load_kml(std::string_view text, const std::string& file, const char* hint);

/// Returns the places in <coordinates>, "longitude,latitude[,altitude] ...". Throws InputError for others.
KmlPlaces kml_places(const pugi::xpath_node_set& coordinates, const std::string& file);

}  // namespace flightwatt::path
