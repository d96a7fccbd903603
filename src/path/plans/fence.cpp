#include "path/plans/fence.h"

#include "path/coverage/closed_zones.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

/// Parts of a fence, from the plan's first place.
struct Fence {
    std::vector<Polygon> excluded;
    std::vector<Polygon> included;
};

LocalPosition place_of(const Json& corner, const GeodeticPosition& origin) {
    return to_local({corner.at(0).get<double>(), corner.at(1).get<double>()}, origin);
}

Polygon circle_of(const Json& circle, const GeodeticPosition& origin) {
    constexpr int corners = 32;
    const auto centre = place_of(circle.at("center"), origin);
    const double radius_m = circle.at("radius").get<double>() / std::cos(std::numbers::pi / corners);
    Polygon polygon;
    for (int i = 0; i < corners; ++i) polygon.push_back(moved(centre, radius_m, i * 360.0 / corners));
    return polygon;
}

Fence read_fence(const Json& fence, const GeodeticPosition& origin) {
    Fence read;
    const auto list_of = [&](const Json& part) -> auto& {
        return part.at("inclusion").get<bool>() ? read.included : read.excluded;
    };
    for (const auto& part : fence.value("polygons", Json::array())) {
        auto& polygon = list_of(part).emplace_back();
        for (const auto& corner : part.at("polygon")) polygon.push_back(place_of(corner, origin));
    }
    for (const auto& part : fence.value("circles", Json::array()))
        list_of(part).push_back(circle_of(part.at("circle"), origin));
    return read;
}

/// Returns whether a straight line is in a polygon from its beginning to its end.
bool is_within(const Polygon& polygon, const LocalPosition& from, const LocalPosition& to) {
    constexpr double tolerance_m = 0.1;
    const double course_deg = course_between(from, to);
    const auto start = along_and_across(from, course_deg);
    const double end_m = start.along_m + distance_between_m(from, to);
    return std::ranges::any_of(parts_within(polygon, course_deg, start.across_m), [&](const LinePart& part) {
        return part.from_m <= start.along_m + tolerance_m && end_m - tolerance_m <= part.to_m;
    });
}

void add_note(const std::vector<std::string>& names, const char* what, std::vector<std::string>& notes) {
    if (names.empty()) return;
    const auto more = names.size() == 1 ? "" : fmt::format(" (and {} more)", names.size() - 1);
    notes.push_back(fmt::format("{}{}: the way there {}", names.front(), more, what));
}

}  // namespace

std::vector<std::string> fence_notes(const Json& plan, const std::vector<PathEntry>& entries) {
    const auto first = std::ranges::find_if(entries, [](const auto& entry) { return !!entry.geographic; });
    if (!plan.contains("geoFence") || first == entries.end()) return {};
    Fence fence;
    try {
        fence = read_fence(plan["geoFence"], *first->geographic);
    } catch (const Json::exception&) {
        return {"the plan's geofence is not understood: whether the path keeps it is unknown"};
    }
    std::vector<std::string> crossing, outside;
    const ClosedZones excluded(fence.excluded, 0.0);
    LocalPosition at;
    for (auto entry = first; entry != entries.end(); ++entry) {
        if (!entry->geographic) continue;
        const auto to = to_local(*entry->geographic, *first->geographic);
        const auto keeps = [&](const Polygon& polygon) { return is_within(polygon, at, to); };
        if (excluded.are_crossed(at, to)) crossing.push_back(entry->name);
        if (!fence.included.empty() && std::ranges::none_of(fence.included, keeps)) outside.push_back(entry->name);
        at = to;
    }
    std::vector<std::string> notes;
    add_note(crossing, "crosses an excluded fence", notes);
    add_note(outside, "is not within the fence", notes);
    return notes;
}

}  // namespace flightwatt::path
