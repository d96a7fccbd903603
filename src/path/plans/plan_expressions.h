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

/// Returns the value of a name or a call; std::nullopt for an unknown one.
using NamedValues = std::function<std::optional<double>(const std::string&)>;

/// Evaluates sums and products of numbers, and of names and calls that `value_of` knows; std::nullopt for anything
/// else.
std::optional<double> evaluate(std::string_view expression, const NamedValues& value_of);

/// Returns name and arguments of a call such as "nav_line_run(WP_1, WP_2, nav_radius)".
std::pair<std::string, std::vector<std::string>> function_call(const std::string& text);

/// Returns the number that one of the names must exceed by a condition such as "NavCircleCount() @GT 0.5" or
/// "stage_time>10"; std::nullopt for other conditions.
std::optional<double> find_limit(const std::string& condition, std::initializer_list<std::string_view> names);

}  // namespace flightwatt::path
