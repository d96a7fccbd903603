#include "path/plans/kml.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "path/plans/plan_expressions.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::path {

pugi::xml_document load_kml(std::string_view text, const std::string& file, const char* hint) {
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer(text.data(), text.size()); !parsed)
        throw InputError({file}, fmt::format("is not XML: {}", parsed.description()), hint);
    return document;
}

KmlPlaces kml_places(const pugi::xpath_node_set& coordinates, const std::string& file) {
    KmlPlaces found;
    std::optional<double> first_m;
    for (const auto& node : coordinates)
        for (const auto& place : split(node.node().text().get(), " \t\r\n")) {
            const auto parts = split(place, ",");
            const auto longitude = parse_number(parts.empty() ? "" : parts[0]);
            const auto latitude = parse_number(parts.size() < 2 ? "" : parts[1]);
            if (!longitude || !latitude || std::abs(*latitude) > 90.0 || std::abs(*longitude) > 180.0)
                throw InputError({file}, fmt::format("a place '{}'", truncated(place)),
                                 "expected longitude,latitude in degrees");
            found.places.push_back({*latitude, *longitude});
            const double altitude_m = parts.size() > 2 ? parse_number(parts[2]).value_or(0.0) : 0.0;
            if (altitude_m != 0.0) found.has_altitudes = true;
            if (altitude_m != first_m.value_or(altitude_m)) found.is_level = false;
            if (!first_m) first_m = altitude_m;
        }
    return found;
}

}  // namespace flightwatt::path
