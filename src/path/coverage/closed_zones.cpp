#include "path/coverage/closed_zones.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace flightwatt::path {
namespace {

constexpr double tolerance_m = 0.1;

/// Appends the parts of a line that are within a distance from the edge between two places.
void add_parts_beside(const LocalPosition& from, const LocalPosition& to, double distance_m, double course_deg,
                      const CourseAxes& axes, double offset_m, std::vector<LinePart>& parts) {
    const auto corner = along_and_across(from, axes);
    const double beside_m = corner.across_m - offset_m;
    const double other_m = along_and_across(to, axes).across_m - offset_m;
    if (std::min(beside_m, other_m) > distance_m || std::max(beside_m, other_m) < -distance_m) return;
    const double right_deg = course_between(from, to) + 90.0;
    const Polygon strip{moved(from, distance_m, right_deg), moved(to, distance_m, right_deg),
                        moved(to, -distance_m, right_deg), moved(from, -distance_m, right_deg)};
    for (const auto& part : parts_within(strip, course_deg, offset_m)) parts.push_back(part);
    if (std::abs(beside_m) >= distance_m) return;
    const double half_m = std::sqrt(distance_m * distance_m - beside_m * beside_m);
    parts.push_back({corner.along_m - half_m, corner.along_m + half_m});
}

}  // namespace

std::vector<LinePart> parts_within(const Polygon& polygon, double course_deg, double offset_m) {
    const auto crossings = line_crossings(polygon, course_deg, offset_m);
    std::vector<LinePart> parts;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) parts.push_back({crossings[i], crossings[i + 1]});
    return parts;
}

ClosedZones::ClosedZones(std::vector<Polygon> zones, double distance_m)
    : zones_(std::move(zones)), distance_m_(distance_m) {
    constexpr int around = 8;  // places around each corner
    const double radius_m = (distance_m + tolerance_m) / std::cos(std::numbers::pi / around);
    for (const auto& zone : zones_)
        for (const auto& corner : zone)
            for (int i = 0; i < around; ++i) {
                const auto place = moved(corner, radius_m, i * 360.0 / around);
                if (!are_crossed(moved(place, tolerance_m, 0.0), moved(place, tolerance_m, 180.0)))
                    corners_.push_back(place);
            }
}

std::vector<LinePart> ClosedZones::parts_of_line(double course_deg, double offset_m) const {
    return parts_of_line(course_deg, offset_m, distance_m_);
}

std::vector<LinePart> ClosedZones::parts_of_line(double course_deg, double offset_m, double distance_m) const {
    std::vector<LinePart> parts;
    const auto axes = axes_of(course_deg);
    for (const auto& zone : zones_) {
        for (const auto& part : parts_within(zone, course_deg, offset_m)) parts.push_back(part);
        for (std::size_t i = 0; i < zone.size() && distance_m > 0.0; ++i)
            add_parts_beside(zone[i], zone[(i + 1) % zone.size()], distance_m, course_deg, axes, offset_m, parts);
    }
    return parts;
}

bool ClosedZones::are_crossed(const LocalPosition& from, const LocalPosition& to) const {
    const double course_deg = course_between(from, to);
    const auto start = along_and_across(from, course_deg);
    const double end_m = start.along_m + distance_between_m(from, to);
    // Places at the distance, as the ends of lines, have a way along it, whatever is rounded.
    const auto parts = parts_of_line(course_deg, start.across_m, distance_m_ - tolerance_m);
    return std::ranges::any_of(parts, [&](const LinePart& part) {
        return std::min(part.to_m, end_m) - std::max(part.from_m, start.along_m) > tolerance_m;
    });
}

std::optional<std::vector<LocalPosition>> ClosedZones::way_around(const LocalPosition& from,
                                                                  const LocalPosition& to) const {
    if (!are_crossed(from, to)) return std::vector<LocalPosition>{};
    // Dijkstra's algorithm over the corners; the first node is `from`, the last one `to`.
    std::vector<LocalPosition> nodes{from};
    nodes.insert(nodes.end(), corners_.begin(), corners_.end());
    nodes.push_back(to);
    constexpr double unknown = std::numeric_limits<double>::infinity();
    std::vector<double> length_m(nodes.size(), unknown);
    std::vector<std::size_t> before(nodes.size(), 0);
    std::vector<bool> is_done(nodes.size(), false);
    length_m.front() = 0.0;
    while (!is_done.back()) {
        std::size_t next = nodes.size();
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!is_done[i] && length_m[i] < unknown && (next == nodes.size() || length_m[i] < length_m[next]))
                next = i;
        if (next == nodes.size()) return std::nullopt;
        is_done[next] = true;
        for (std::size_t i = 1; i < nodes.size(); ++i) {
            const double through_m = length_m[next] + distance_between_m(nodes[next], nodes[i]);
            if (is_done[i] || through_m >= length_m[i] || are_crossed(nodes[next], nodes[i])) continue;
            length_m[i] = through_m;
            before[i] = next;
        }
    }
    std::vector<LocalPosition> way;
    for (std::size_t node = before.back(); node != 0; node = before[node]) way.push_back(nodes[node]);
    std::ranges::reverse(way);
    return way;
}

}  // namespace flightwatt::path
