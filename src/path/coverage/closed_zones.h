#pragma once

#include "path/plans/patterns.h"

#include <optional>
#include <vector>

namespace flightwatt::path {

/// A part of a straight line, by distances along it from the place nearest to the origin.
struct LinePart {
    double from_m = 0.0;
    double to_m = 0.0;
};

/// Returns the parts of a line within a polygon, in the order of the line: it has the course `course_deg` and passes the
/// origin `offset_m` to its right.
std::vector<LinePart> parts_within(const Polygon& polygon, double course_deg, double offset_m);

/// Zones over which an aircraft must not fly, and the ways around them.
class ClosedZones {
  public:
    /// Takes the zones, and a distance that is kept from them.
    ClosedZones(std::vector<Polygon> zones, double distance_m);

    /// Returns the parts of a line that are in a zone or nearer to it than the distance; they may overlap.
    std::vector<LinePart> parts_of_line(double course_deg, double offset_m) const;

    /// Returns whether the straight way between two places leads more than 0.1 m through a zone, or more than 0.1 m nearer
    /// to it than the distance.
    bool are_crossed(const LocalPosition& from, const LocalPosition& to) const;

    /// Returns the places at which the shortest way around the zones turns; none if there is no way.
    std::optional<std::vector<LocalPosition>> way_around(const LocalPosition& from, const LocalPosition& to) const;

  private:
    std::vector<LinePart> parts_of_line(double course_deg, double offset_m, double distance_m) const;

    std::vector<Polygon> zones_;
    double distance_m_;
    std::vector<LocalPosition> corners_;  ///< places around their corners, at a little more than the distance
};

}  // namespace flightwatt::path
