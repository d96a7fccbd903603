#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

/// Lines of a parameter file as QGroundControl loads it.
namespace flightwatt::exchange {

/// MAV_PARAM_TYPE of MAVLink.
enum class ParameterType { int32 = 6, real32 = 9 };

/// Returns the line of a parameter.
inline std::string px4_line(std::string_view name, double value, ParameterType type = ParameterType::real32) {
    const auto text = type == ParameterType::int32 ? fmt::format("{:.0f}", value) : fmt::format("{:.9g}", value);
    return fmt::format("1\t1\t{}\t{}\t{}\n", name, text, static_cast<int>(type));
}

/// Returns the head of the file.
inline std::string px4_head(const char* reader) {
    return fmt::format("# Written by flightwatt export " FLIGHTWATT_VERSION
                       ", for {} and QGroundControl\n"
                       "# Vehicle-Id Component-Id Name Value Type\n",
                       reader);
}

}  // namespace flightwatt::exchange
