#include "compute/qos_range.h"

#include "base/number.h"

#include <cmath>

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

}  // namespace flightwatt::compute
