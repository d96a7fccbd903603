#include "base/duration_text.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt {
namespace {

constexpr long long seconds_a_minute = 60;
constexpr long long minutes_an_hour = 60;

std::string in_parts(long long whole, const char* unit, long long rest, const char* unit_of_rest) {
    if (rest == 0) return fmt::format("{} {}", whole, unit);
    return fmt::format("{} {} {} {}", whole, unit, rest, unit_of_rest);
}

}  // namespace

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return "-";
    if (seconds < 0.0) return "-" + duration_text(-seconds);
    constexpr double rounds_to_a_minute = 59.95;
    constexpr double rounds_to_an_hour = 3599.5;
    if (seconds < rounds_to_a_minute) return fmt::format("{:.1f} s", seconds);
    if (seconds < rounds_to_an_hour) {
        const auto whole = std::llround(seconds);
        return in_parts(whole / seconds_a_minute, "min", whole % seconds_a_minute, "s");
    }
    const auto minutes = std::llround(seconds / static_cast<double>(seconds_a_minute));
    return in_parts(minutes / minutes_an_hour, "h", minutes % minutes_an_hour, "min");
}

}  // namespace flightwatt
