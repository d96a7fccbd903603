#include "compute/qos_range.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

constexpr double rounding = 1e-9;  // of a step

double rounded(double value) { return number_or_nan(fmt::format("{:.12g}", value)); }

double squared_distance(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

bool is_corner(const std::vector<double>& unit_point) {
    return std::ranges::all_of(unit_point, [](double x) { return x == 0.0 || x == 1.0; });
}

std::vector<double> values_on(const QosPoints& points, std::size_t axis) {
    std::set<double> values;
    for (const auto& point : points) values.insert(point[axis]);
    return {values.begin(), values.end()};
}

}  // namespace

std::vector<double> linear_range(double from, double to, double step) {
    std::vector<double> values;
    const double steps = std::floor((to - from) / step + rounding);
    for (int i = 0; i <= steps; ++i) values.push_back(rounded(from + i * step));
    return values;
}

std::vector<double> geometric_range(double from, double to, double factor) {
    std::vector<double> values;
    double value = from;
    while (value <= to) {
        values.push_back(rounded(value));
        value = value > 0.0 ? value * factor : factor;
    }
    return values;
}

QosPoints cartesian_product(const std::vector<QosRange>& ranges) {
    QosPoints combinations{{}};
    for (const auto& range : ranges) {
        QosPoints longer;
        for (const auto& combination : combinations) {
            for (const double value : range.values) {
                longer.push_back(combination);
                longer.back().push_back(value);
            }
        }
        combinations = std::move(longer);
    }
    return combinations;
}

std::string format_qos(const std::vector<std::string>& parameters, const std::vector<double>& qos,
                       std::string_view equals, std::string_view between) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < qos.size(); ++i) {
        parts.push_back(fmt::format("{}{}{}", parameters[i], equals, qos[i]));
    }
    return fmt::format("{}", fmt::join(parts, between));
}

std::string substitute_qos(const std::string& text, const std::vector<std::string>& parameters,
                           const std::vector<double>& qos) {
    std::string result = text;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const auto placeholder = "{" + parameters[i] + "}";
        const auto value = fmt::format("{}", qos[i]);
        for (auto at = result.find(placeholder); at != std::string::npos;
             at = result.find(placeholder, at + value.size())) {
            result.replace(at, placeholder.size(), value);
        }
    }
    return result;
}

QosPoints unit_points(const QosPoints& points, AxisScale scale) {
    auto unit = points;
    const std::size_t axes = points.empty() ? 0 : points.front().size();
    for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto values = values_on(points, axis);
        const double range = values.back() - values.front();
        for (auto& point : unit) {
            const auto place = std::lower_bound(values.begin(), values.end(), point[axis]) - values.begin();
            if (values.size() == 1)
                point[axis] = 0.0;
            else if (scale == AxisScale::rank)
                point[axis] = static_cast<double>(place) / static_cast<double>(values.size() - 1);
            else
                point[axis] = (point[axis] - values.front()) / range;
        }
    }
    return unit;
}

std::vector<std::size_t> select_maximin(const QosPoints& points, std::size_t count) {
    const auto unit = unit_points(points, AxisScale::rank);
    std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> chosen;
    bool corners = std::ranges::any_of(unit, is_corner);
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
