#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::compute {

/// Limit of a component: more would take weeks to profile.
inline constexpr std::size_t max_configurations = 100000;

/// Configurations of a component: one value a parameter each.
using QosPoints = std::vector<std::vector<double>>;

/// A parameter of quality of service and the values that it is profiled at.
struct QosRange {
    std::string name;
    std::vector<double> values;  ///< rising
};

/// from, from + step, ... up to `to`, included if it is a whole number of steps away; `step` > 0, `to` >= `from`.
/// Rounded to 12 digits, so that 0.1 + 0.2 is 0.3 on a command line.
std::vector<double> linear_range(double from, double to, double step);

/// The node `index` of a grid, the last axis running fastest.
std::vector<double> grid_point(const std::vector<std::vector<double>>& axes, std::size_t index);

/// Every combination of the values, the last parameter running fastest; one empty combination of no ranges.
QosPoints cartesian_product(const std::vector<QosRange>& ranges);

/// "fps=4 key_bits=32", or with other texts between name and value and between parameters.
std::string format_qos(const std::vector<std::string>& parameters, const std::vector<double>& qos,
                       std::string_view equals = "=", std::string_view between = " ");

/// `text` with every {name} of a parameter replaced by its value; other braces are kept (they may be a shell's).
std::string substitute_qos(const std::string& text, const std::vector<std::string>& parameters,
                           const std::vector<double>& qos);

}  // namespace flightwatt::compute
