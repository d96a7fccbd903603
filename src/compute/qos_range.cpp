#include "compute/qos_range.h"

#include "base/number.h"

#include <cmath>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

constexpr double rounding = 1e-9;  // of a step

double rounded(double value) { return number_or_nan(fmt::format("{:.12g}", value)); }

}  // namespace

std::vector<double> linear_range(double from, double to, double step) {
    std::vector<double> values;
    const double steps = std::floor((to - from) / step + rounding);
    for (int i = 0; i <= steps; ++i) values.push_back(rounded(from + i * step));
    return values;
}

std::vector<double> grid_point(const std::vector<std::vector<double>>& axes, std::size_t index) {
    std::vector<double> point(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        point[i] = axes[i][index % axes[i].size()];
        index /= axes[i].size();
    }
    return point;
}

QosPoints cartesian_product(const std::vector<QosRange>& ranges) {
    std::vector<std::vector<double>> axes;
    std::size_t count = 1;
    for (const auto& range : ranges) {
        axes.push_back(range.values);
        count *= range.values.size();
    }
    QosPoints points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(grid_point(axes, i));
    return points;
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
    auto result = text;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        boost::algorithm::replace_all(result, "{" + parameters[i] + "}", fmt::format("{}", qos[i]));
    return result;
}

}  // namespace flightwatt::compute
