#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// What is known of a log beside its values.
namespace flightwatt::telemetry {

/// Where the autopilot's current came from.
enum class CurrentOrigin {
    unknown,
    sensor,    ///< the airframe converts an ADC reading: MilliAmpereOfAdc
    throttle,  ///< computed from it (MILLIAMP_AT_FULL_THROTTLE alone): a power model fitted to it is circular
};

/// "measured by a sensor", "computed from throttle" or "unknown".
std::string_view to_string(CurrentOrigin origin);

/// Lines or values that could not be used, by reason and time; of binary logs frames, or bytes between them. What has
/// no time counts to the next message that has: what stands behind the last message of a log has an infinite time.
struct SkippedLines {
    enum class Unit { line, frame, byte };
    struct AtTime {
        double time_s = 0.0;
        std::size_t count = 0;
        std::size_t first_line = 0;  ///< of a binary log the first byte, from 1 as well
        bool operator==(const AtTime&) const = default;
    };
    std::string reason;
    std::vector<AtTime> lines;  ///< by time, which rises strictly
    Unit unit = Unit::line;     ///< what is counted

    std::size_t count() const;
    std::size_t first_line() const;  ///< 0 without any
    bool operator==(const SkippedLines&) const = default;
};

std::string_view to_string(SkippedLines::Unit unit);

/// "ENERGY: another number of fields than the .log defines: 3 lines, first at line 17"; of a binary log "damaged: 3
/// bytes, first at byte 1201".
std::string describe(const SkippedLines& skipped);

/// A message's layout that was assumed for want of a .log, or what was assumed of its units where the .log has none or
/// none that is known; and since when it was needed.
struct AssumedDefinition {
    std::string text;  ///< "ENERGY: 2018 (6 fields)", "POWER_DEVICE: current has none: A is assumed"
    double since_s = 0.0;
    bool operator==(const AssumedDefinition&) const = default;
};

}  // namespace flightwatt::telemetry
