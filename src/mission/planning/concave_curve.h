#pragma once

#include <vector>

namespace flightwatt::mission {

struct CurvePoint {
    double x = 0.0;
    double y = 0.0;
};

/// Straight lines between points, concave and nowhere falling; minus infinity before the first point, level beyond the
/// last. Without points: minus infinity.
struct ConcaveCurve {
    std::vector<CurvePoint> points;
};

/// The least such curve that is nowhere below any of the points.
ConcaveCurve concave_hull(std::vector<CurvePoint> points);

double value_at(const ConcaveCurve& curve, double x);

/// What is known of a rising map over a part of its axis: where the part's end is mapped to, and that the map rises by
/// at least `growth` for 1.
struct MappedCell {
    double start = 0.0;
    double end = 0.0;
    double end_maps_to = 0.0;
    double growth = 1.0;
};

/// Adds points under whose hull lies `curve` plus `gain`, applied to whatever the map may be within the cell.
void add_mapped(const ConcaveCurve& curve, const MappedCell& cell, double gain, std::vector<CurvePoint>& points);

}  // namespace flightwatt::mission
