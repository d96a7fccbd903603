#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Expressions in the attributes of Paparazzi's flight plans.
namespace flightwatt::path {

/// Value of sums and products of numbers, and of names and calls that `value_of` knows; none for anything else.
using NamedValues = std::function<std::optional<double>(const std::string&)>;

std::optional<double> evaluate(std::string_view expression, const NamedValues& value_of);

/// Name and arguments of "nav_line_run(WP_1, WP_2, nav_radius)".
std::pair<std::string, std::vector<std::string>> function_call(const std::string& text);

/// The number above which a condition wants one of the names, as "NavCircleCount() @GT 0.5" or "stage_time>10".
std::optional<double> find_limit(const std::string& condition, std::initializer_list<std::string_view> names);

/// The parts between any of the separators that are not empty.
std::vector<std::string> split(const std::string& text, const char* separators);

}  // namespace flightwatt::path
