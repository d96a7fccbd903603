#include "compute/profiling/spread_nodes.h"

#include <algorithm>
#include <limits>

namespace flightwatt::compute {
namespace {

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

bool is_corner(const std::vector<double>& unit_point) {
    return std::all_of(unit_point.begin(), unit_point.end(), [](double x) { return x == 0.0 || x == 1.0; });
}

std::vector<double> values_on(const std::vector<std::vector<double>>& points, std::size_t axis) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const auto& point : points) values.push_back(point[axis]);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

}  // namespace

std::vector<std::vector<double>> unit_points(const std::vector<std::vector<double>>& points,
                                             AxisScale scale) {
    auto unit = points;
    const std::size_t axes = points.empty() ? 0 : points.front().size();
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto values = values_on(points, axis);
        const double span = values.back() - values.front();
        for (auto& point : unit) {
            const auto place = std::lower_bound(values.begin(), values.end(), point[axis]) - values.begin();
            if (values.size() == 1)
                point[axis] = 0.0;
            else if (scale == AxisScale::rank)
                point[axis] = static_cast<double>(place) / static_cast<double>(values.size() - 1);
            else
                point[axis] = (point[axis] - values.front()) / span;
        }
    }
    return unit;
}

std::vector<std::size_t> spread_nodes(const std::vector<std::vector<double>>& points, std::size_t count) {
    const auto unit = unit_points(points, AxisScale::rank);
    std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> chosen;
    bool corners = std::any_of(unit.begin(), unit.end(), is_corner);
    while (chosen.size() < std::min(count, points.size())) {
        std::size_t best = points.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (distance[i] == 0.0 || (corners && !is_corner(unit[i]))) continue;
            if (best == points.size() || distance[i] > distance[best]) best = i;
        }
        if (best == points.size()) {
            if (!corners) break;  // what is left stands where another one does
            corners = false;
            continue;
        }
        chosen.push_back(best);
        for (std::size_t i = 0; i < points.size(); ++i) {
            distance[i] = std::min(distance[i], squared_distance(unit[i], unit[best]));
        }
    }
    return chosen;
}

}  // namespace flightwatt::compute
