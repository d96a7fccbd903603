#include "telemetry/log_notes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::telemetry {

std::string_view to_string(CurrentOrigin origin) {
    switch (origin) {
        case CurrentOrigin::sensor:
            return "measured by a sensor";
        case CurrentOrigin::throttle:
            return "computed from throttle";
        case CurrentOrigin::unknown:
            break;
    }
    return "unknown";
}

std::size_t SkippedLines::count() const {
    return std::accumulate(lines.begin(), lines.end(), std::size_t{0},
                           [](std::size_t sum, const AtTime& at) { return sum + at.count; });
}

std::size_t SkippedLines::first_line() const {
    const auto first = std::ranges::min_element(lines, {}, &AtTime::first_line);
    return first == lines.end() ? 0 : first->first_line;
}

std::string_view to_string(SkippedLines::Unit unit) {
    switch (unit) {
        case SkippedLines::Unit::frame:
            return "frame";
        case SkippedLines::Unit::byte:
            return "byte";
        case SkippedLines::Unit::line:
            break;
    }
    return "line";
}

bool is_partial_record(const SkippedLines& skipped) {
    constexpr std::size_t block_bytes = 4096;
    const auto most = skipped.unit == SkippedLines::Unit::byte ? block_bytes : 1;
    return skipped.count() <= most &&
           std::ranges::all_of(skipped.lines, [](const auto& at) { return std::isinf(at.time_s); });
}

std::string describe(const SkippedLines& skipped) {
    const auto unit = to_string(skipped.unit);
    const auto place = skipped.unit == SkippedLines::Unit::line ? "line" : "byte";
    const auto first = skipped.first_line();
    return fmt::format("{}: {} {}{}{}", skipped.reason, skipped.count(), unit, skipped.count() == 1 ? "" : "s",
                       first == 0 ? "" : fmt::format(", first at {} {}", place, first));
}

}  // namespace flightwatt::telemetry
