#include "report/outline.h"

#include "base/error.h"
#include "base/input_file.h"
#include "record/record.h"

#include <algorithm>

namespace flightwatt::report {
namespace {

/// Adds every list of positions in a GeoJSON's coordinates.
void collect_outlines(const Json& value, std::vector<Outline>& outlines) {
    if (value.is_object()) {
        for (const auto& member : value) collect_outlines(member, outlines);
        return;
    }
    if (!value.is_array()) return;
    const auto is_position = [](const Json& one) {
        return one.is_array() && one.size() >= 2 && one[0].is_number() && one[1].is_number();
    };
    if (value.size() < 2 || !std::ranges::all_of(value, is_position)) {
        for (const auto& member : value) collect_outlines(member, outlines);
        return;
    }
    Outline outline;
    for (const auto& one : value) outline.emplace_back(one[0].get<double>(), one[1].get<double>());
    outlines.push_back(std::move(outline));
}

}  // namespace

std::vector<Outline> read_outlines(const std::filesystem::path& file) {
    std::vector<Outline> outlines;
    const auto json = Json::parse(read_file(file), nullptr, false);
    if (json.is_discarded()) throw InputError({file.string()}, "is not JSON", "expected GeoJSON (RFC 7946)");
    collect_outlines(json, outlines);
    if (outlines.empty())
        throw InputError({file.string()}, "has no line and no polygon",
                         "expected GeoJSON with coordinates in degrees, longitude first");
    return outlines;
}

}  // namespace flightwatt::report
