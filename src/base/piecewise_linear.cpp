#include "base/piecewise_linear.h"

#include <algorithm>
#include <cmath>

namespace flightwatt {

KnotInterval find_knot_interval(std::span<const double> knots, double x) {
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
    const auto lower = static_cast<std::size_t>(above - knots.begin()) - 1;
    return {lower, (x - knots[lower]) / (knots[lower + 1] - knots[lower])};
}

double interpolate_clamped(std::span<const double> knots, std::span<const double> values, double x) {
    if (!(x > knots.front())) return values.front();
    if (x >= knots.back()) return values.back();
    return interpolate_extended(knots, values, x);
}

double interpolate_extended(std::span<const double> knots, std::span<const double> values, double x) {
    const auto place = find_knot_interval(knots, x);
    return std::lerp(values[place.lower], values[place.lower + 1], place.fraction);
}

}  // namespace flightwatt
