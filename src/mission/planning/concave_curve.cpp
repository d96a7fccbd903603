#include "mission/planning/schedule_value.h"

#include <algorithm>
#include <limits>

namespace flightwatt::mission {
namespace {

/// Whether b is on or below the line from a to c.
bool is_under(const CurvePoint& a, const CurvePoint& b, const CurvePoint& c) {
    return (b.y - a.y) * (c.x - a.x) <= (c.y - a.y) * (b.x - a.x);
}

auto first_beyond(const ConcaveCurve& curve, double x) {
    return std::ranges::upper_bound(curve.points, x, {}, &CurvePoint::x);
}

}  // namespace

ConcaveCurve concave_hull(std::vector<CurvePoint> points) {
    std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y > b.y; });
    ConcaveCurve hull;
    auto& kept = hull.points;
    for (const auto& point : points) {
        if (!kept.empty() && point.y <= kept.back().y) continue;  // below where the curve is level
        while (kept.size() >= 2 && is_under(kept[kept.size() - 2], kept.back(), point)) kept.pop_back();
        kept.push_back(point);
    }
    return hull;
}

double value_at(const ConcaveCurve& curve, double x) {
    const auto& points = curve.points;
    if (points.empty() || x < points.front().x) return -std::numeric_limits<double>::infinity();
    if (x >= points.back().x) return points.back().y;
    const auto after = first_beyond(curve, x);
    const auto& b = *after;
    const auto& a = *(after - 1);
    return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

void add_mapped(const ConcaveCurve& curve, const MappedCell& cell, double gain, std::vector<CurvePoint>& points) {
    if (curve.points.empty() || !(cell.end_maps_to >= curve.points.front().x)) return;
    const double least = cell.end_maps_to - cell.growth * (cell.end - cell.start);
    points.push_back({cell.end, gain + value_at(curve, cell.end_maps_to)});
    for (auto point = first_beyond(curve, least); point != curve.points.end() && point->x < cell.end_maps_to; ++point)
        points.push_back({cell.end - (cell.end_maps_to - point->x) / cell.growth, gain + point->y});
    if (least >= curve.points.front().x) points.push_back({cell.start, gain + value_at(curve, least)});
}

}  // namespace flightwatt::mission
