#pragma once

#include "path/path.h"

#include <variant>
#include <vector>

namespace flightwatt::path {

/// A place that is passed on a course.
struct Pose {
    LocalPosition place;
    double course_deg = 0.0;
};

/// Returns the shortest way from one pose to another with turns of one radius (Dubins, American Journal of Mathematics
/// 79, 1957): at most three legs and parts of circles; none between equal poses.
std::vector<std::variant<Leg, Circles, Hold>> shortest_way(const Pose& from, const Pose& to, double radius_m);

}  // namespace flightwatt::path
