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

/// A rising map on an interval: the image of its end, and the least slope.
struct MappedCell {
    double start = 0.0;
    double end = 0.0;
    double end_maps_to = 0.0;
    double growth = 1.0;
};

/// Adds points whose hull is an upper bound of `gain` plus `curve` of any map that is possible within the cell.
void add_mapped(const ConcaveCurve& curve, const MappedCell& cell, double gain, std::vector<CurvePoint>& points);

}  // namespace flightwatt::mission
