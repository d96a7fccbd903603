#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Metadata of a log.
namespace flightwatt::telemetry {

/// Source of the autopilot's current.
enum class CurrentOrigin {
    unknown,
    sensor,    ///< the airframe converts an ADC reading: MilliAmpereOfAdc
    throttle,  ///< computed from it (MILLIAMP_AT_FULL_THROTTLE alone): a power model fitted to it is circular
};

/// "measured by a sensor", "computed from throttle" or "unknown".
std::string_view to_string(CurrentOrigin origin);

/// Unusable lines or values by reason and time; of binary logs frames, or bytes between them. A line without a time
/// gets that of the next message, or an infinite time after the last message.
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
    Unit unit = Unit::line;

    std::size_t count() const;
    std::size_t first_line() const;  ///< 0 without any
    bool operator==(const SkippedLines&) const = default;
};

std::string_view to_string(SkippedLines::Unit unit);

/// Whether these are all at the end, as much as a log that is cut at power-off has: a line, a frame, or bytes of one
/// block of a card behind the last message.
bool is_partial_record(const SkippedLines& skipped);

/// "ENERGY: another number of fields than the .log defines: 3 lines, first at line 17"; of a binary log "damaged: 3
/// bytes, first at byte 1201".
std::string describe(const SkippedLines& skipped);

/// A message layout that was assumed because there is no .log, or a unit because the .log has none or an unknown one;
/// and the time from which on it was needed.
struct AssumedDefinition {
    std::string text;  ///< "ENERGY: 2018 (6 fields)", "POWER_DEVICE: current has no unit: A is assumed"
    double since_s = 0.0;
    bool operator==(const AssumedDefinition&) const = default;
};

}  // namespace flightwatt::telemetry
