#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt::compute {

/// How the values of a parameter become coordinates from 0 to 1.
enum class AxisScale {
    value,  ///< in proportion
    rank    ///< by their place among the values that occur: fits ranges that double
};

/// Points (one value a parameter each) in the unit cube, each axis scaled by the values that occur on it. An
/// axis with one value is 0.
std::vector<std::vector<double>> unit_points(const std::vector<std::vector<double>>& points, AxisScale scale);

/// `count` of the points, as indices in the order chosen: first the corners of their range, then always the
/// one farthest from those chosen (maximin), by rank. All of them if count is not less.
std::vector<std::size_t> spread_nodes(const std::vector<std::vector<double>>& points, std::size_t count);

}  // namespace flightwatt::compute
