#include "path/plans/kml.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::path {

pugi::xml_document load_kml(std::string_view text, const std::string& file, const char* hint) {
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer(text.data(), text.size()); !parsed)
        throw InputError({file}, fmt::format("is not XML: {}", parsed.description()), hint);
    return document;
}

std::vector<KmlPlace> kml_places(const pugi::xml_node& coordinates, const std::string& file) {
    std::vector<KmlPlace> places;
    for (const auto& text : split(coordinates.text().get(), " \t\r\n")) {
        const auto parts = split(text, ",");
        const auto longitude = parse_number(parts.empty() ? "" : parts[0]);
        const auto latitude = parse_number(parts.size() < 2 ? "" : parts[1]);
        const auto altitude = parts.size() < 3 ? std::nullopt : parse_number(parts[2]);
        if (!longitude || !latitude || std::abs(*latitude) > 90.0 || std::abs(*longitude) > 180.0 ||
            (parts.size() > 2 && !altitude))
            throw InputError({file}, fmt::format("a place '{}'", truncated(text)),
                             "expected longitude,latitude in degrees and, if at all, an altitude in metres");
        places.push_back({{*latitude, *longitude}, altitude});
    }
    return places;
}

}  // namespace flightwatt::path
