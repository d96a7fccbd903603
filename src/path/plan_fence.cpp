#include "path/plan_fence.h"

#include "path/coverage/closed_zones.h"
#include "path/path_entries.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

std::vector<Polygon> in_metres(const std::vector<std::vector<GeodeticPosition>>& outlines,
                               const GeodeticPosition& origin) {
    std::vector<Polygon> polygons(outlines.size());
    for (std::size_t i = 0; i < outlines.size(); ++i)
        for (const auto& corner : outlines[i]) polygons[i].push_back(to_local(corner, origin));
    return polygons;
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

/// The places that straight lines join along an element, from its start: chords of one turn of circles.
std::vector<LocalPosition> places_along(const PathElement& element) {
    constexpr int chords = 64;
    const auto* circles = std::get_if<Circles>(&element.shape);
    const FlightPath alone{{element}};
    if (circles == nullptr) return {local_position_at(alone, {1, 0.0})};
    std::vector<LocalPosition> places;
    const double flown = std::min(1.0, 1.0 / circles->turns);
    for (int i = 1; i <= chords; ++i) places.push_back(local_position_at(alone, {0, flown * i / chords}));
    return places;
}

/// Names of elements, each once in a row.
void add_name(const PathElement& element, std::vector<std::string>& names) {
    if (names.empty() || names.back() != element.name) names.push_back(element.name);
}

void add_note(const std::vector<std::string>& names, const char* what, std::vector<std::string>& notes) {
    if (names.empty()) return;
    const auto more = names.size() == 1 ? "" : fmt::format(" (and {} more)", names.size() - 1);
    notes.push_back(fmt::format("{}{}: the way {}", names.front(), more, what));
}

}  // namespace

std::vector<std::string> fence_notes(const PlanFence& fence, const FlightPath& path, const PathOrigin& origin) {
    if (!fence.is_understood) return {"the plan's geofence is not understood: whether the path keeps it is unknown"};
    if (fence.excluded.empty() && fence.included.empty()) return {};
    const auto included = in_metres(fence.included, origin.place);
    const ClosedZones excluded(in_metres(fence.excluded, origin.place), 0.0);
    std::vector<std::string> crossing, outside;
    auto start = origin.start;
    for (const auto& element : path.elements) {
        auto at = start;
        for (const auto& place : places_along(element)) {
            const auto to = start + place;
            const auto keeps = [&](const Polygon& polygon) { return is_within(polygon, at, to); };
            if (excluded.are_crossed(at, to)) add_name(element, crossing);
            if (!included.empty() && at != to && std::ranges::none_of(included, keeps)) add_name(element, outside);
            at = to;
        }
        start = start + local_position_at({{element}}, {1, 0.0});
    }
    std::vector<std::string> notes;
    add_note(crossing, "crosses an excluded fence", notes);
    add_note(outside, "is not within the fence", notes);
    return notes;
}

}  // namespace flightwatt::path
