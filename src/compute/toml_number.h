#pragma once

#include "base/error.h"
#include "base/toml_reader.h"

#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

/// Numbers of a TOML table that have a default and a bound. They throw InputError.
namespace flightwatt::compute {

inline double number_from(const TomlTable& table, std::string_view key, double fallback, double least) {
    const auto value = table.optional_number(key);
    if (!value) return fallback;
    if (*value < least) {
        throw InputError(table.where(key), fmt::format("{} = {}, expected {} or more", key, *value, least));
    }
    return *value;
}

inline double positive_from(const TomlTable& table, std::string_view key, double fallback) {
    const auto value = table.optional_number(key);
    if (value && *value <= 0.0) {
        throw InputError(table.where(key), fmt::format("{} = {}, expected more than 0", key, *value));
    }
    return value.value_or(fallback);
}

inline std::uint64_t count_from(const TomlTable& table, std::string_view key, std::uint64_t fallback,
                                std::uint64_t least) {
    constexpr double most = 1e15;  // whole numbers are exact up to there
    const double value = number_from(table, key, static_cast<double>(fallback), static_cast<double>(least));
    if (value == std::floor(value) && value <= most) return static_cast<std::uint64_t>(value);
    throw InputError(table.where(key), fmt::format("{} = {}, expected a whole number", key, value));
}

}  // namespace flightwatt::compute
