#include "report/outline.h"

#include "base/error.h"
#include "base/input_file.h"
#include "record/record.h"

#include <algorithm>

namespace flightwatt::report {
namespace {

/// Adds every list of positions in a GeoJSON's coordinates.
void collect_outlines(const Json& value, std::vector<Outline>& outlines) {
    const auto is_position = [](const Json& one) {
        return one.is_array() && one.size() >= 2 && one[0].is_number() && one[1].is_number();
    };
    if (value.is_array() && value.size() >= 2 && std::ranges::all_of(value, is_position))
        outlines.push_back(value.get<Outline>());
    else if (value.is_structured())
        for (const auto& member : value) collect_outlines(member, outlines);
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
