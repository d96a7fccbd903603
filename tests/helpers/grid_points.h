#pragma once

#include <vector>

namespace flightwatt::test {

using Points = std::vector<std::vector<double>>;

/// Every pair of an x and a y, x by x.
inline Points grid(const std::vector<double>& xs, const std::vector<double>& ys) {
    Points points;
    for (const double x : xs) {
        for (const double y : ys) points.push_back({x, y});
    }
    return points;
}

}  // namespace flightwatt::test
