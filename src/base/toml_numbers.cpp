#include "base/toml_numbers.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace flightwatt {
namespace {

std::string describe(NumberRange range) {
    if (std::isinf(range.low)) return fmt::format("at most {}", range.high);
    if (std::isinf(range.high)) {
        return range.low_excluded ? fmt::format("more than {}", range.low) : fmt::format("{} or more", range.low);
    }
    return range.low_excluded ? fmt::format("more than {} and at most {}", range.low, range.high)
                              : fmt::format("{} to {}", range.low, range.high);
}

}  // namespace

void require_in(NumberRange range, double value, std::string_view name, const Location& where, std::string_view hint) {
    const bool above_low = range.low_excluded ? value > range.low : value >= range.low;
    if (above_low && value <= range.high) return;
    throw InputError(where, fmt::format("{} = {}, expected {}", name, value, describe(range)), std::string(hint));
}

double number_in(NumberRange range, const TomlTable& table, std::string_view key, std::string_view hint) {
    const double value = table.number(key);
    require_in(range, value, key, table.where(key), hint);
    return value;
}

std::optional<double> optional_number_in(NumberRange range, const TomlTable& table, std::string_view key,
                                         std::string_view hint) {
    const auto value = table.optional_number(key);
    if (value) require_in(range, *value, key, table.where(key), hint);
    return value;
}

double number_in_or(NumberRange range, const TomlTable& table, std::string_view key, double otherwise) {
    return optional_number_in(range, table, key).value_or(otherwise);
}

std::uint64_t count_in(const TomlTable& table, std::string_view key, std::uint64_t least) {
    constexpr double largest_exact = 9007199254740992.0;  // 2^53: beyond, not every whole number is a double
    const double value = table.number(key);
    if (value != std::floor(value) || value > largest_exact) {
        throw InputError(table.where(key), fmt::format("{} = {}, expected a whole number", key, value));
    }
    if (value < static_cast<double>(least)) {
        throw InputError(table.where(key),
                         fmt::format("{} = {}, expected a whole number, {} or more", key, value, least));
    }
    return static_cast<std::uint64_t>(value);
}

std::uint64_t count_in_or(const TomlTable& table, std::string_view key, std::uint64_t least, std::uint64_t otherwise) {
    return table.has(key) ? count_in(table, key, least) : otherwise;
}

}  // namespace flightwatt
