#pragma once

#include <cstddef>
#include <span>

/// Straight lines between knots, which are ascending and, unless noted, at least two.
namespace flightwatt {

/// Position of x among knots: between `lower` and the next one, at `fraction` of the interval.
struct KnotInterval {
    std::size_t lower = 0;
    double fraction = 0.0;
};

/// Beyond the ends, on the first or last line continued: `fraction` is then negative or above 1.
KnotInterval find_knot_interval(std::span<const double> knots, double x);

/// The value at x; beyond the ends, that of the end. One knot or more, as many values.
double interpolate_clamped(std::span<const double> knots, std::span<const double> values, double x);

/// The value at x; beyond the ends, on the first or last line continued.
double interpolate_extended(std::span<const double> knots, std::span<const double> values, double x);

}  // namespace flightwatt
