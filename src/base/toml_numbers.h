#pragma once

#include "base/toml_reader.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

/// Numbers of a TOML table that have a bound. All throw InputError at the key, in the same words.
namespace flightwatt {

/// The numbers that a key may have.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_excluded = false;
};

constexpr NumberRange at_least(double low) { return {low, std::numeric_limits<double>::infinity(), false}; }
constexpr NumberRange more_than(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }
constexpr NumberRange at_most(double high) { return {-std::numeric_limits<double>::infinity(), high, false}; }
constexpr NumberRange between(double low, double high) { return {low, high, false}; }
constexpr NumberRange more_than_up_to(double low, double high) { return {low, high, true}; }

/// Throws InputError at `where`, for `name` = `value`, unless the value is in the range; NaN is not.
void require_in(NumberRange range, double value, std::string_view name, const Location& where,
                std::string_view hint = "");

double number_in(NumberRange range, const TomlTable& table, std::string_view key, std::string_view hint = "");
std::optional<double> optional_number_in(NumberRange range, const TomlTable& table, std::string_view key,
                                         std::string_view hint = "");
double number_in_or(NumberRange range, const TomlTable& table, std::string_view key, double otherwise);

/// A whole number of at least `least`, and small enough that a double holds it exactly.
std::uint64_t count_in(const TomlTable& table, std::string_view key, std::uint64_t least = 0);
std::uint64_t count_in_or(const TomlTable& table, std::string_view key, std::uint64_t least, std::uint64_t otherwise);

}  // namespace flightwatt
