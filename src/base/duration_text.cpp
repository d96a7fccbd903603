#include "base/duration_text.h"

#include "base/units.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace flightwatt {

std::string duration_text(double duration_s) {
    constexpr std::int64_t per_minute = 60;
    constexpr std::int64_t per_hour = 3600;
    constexpr double max_s = 1e9;
    const double length_s = std::abs(duration_s);
    if (!(length_s >= units::seconds_per_minute - 0.05) || length_s > max_s) return fmt::format("{:.1f} s", duration_s);
    const auto whole = static_cast<std::int64_t>(std::llround(length_s));
    std::string text = duration_s < 0.0 ? "-" : "";
    if (whole >= per_hour) text += fmt::format("{} h ", whole / per_hour);
    if (whole % per_hour != 0) text += fmt::format("{} min ", whole % per_hour / per_minute);
    if (whole % per_minute != 0) text += fmt::format("{} s ", whole % per_minute);
    text.pop_back();
    return text;
}

}  // namespace flightwatt
