#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Notes about a log: unusable lines, assumptions and the origin of its current.
namespace flightwatt::telemetry {

/// Source of the current that the autopilot reports.
enum class CurrentOrigin {
    unknown,
    sensor,    ///< the airframe converts an ADC reading: MilliAmpereOfAdc
    throttle,  ///< computed from the throttle (MILLIAMP_AT_FULL_THROTTLE alone): a power model fitted to it is circular
};

/// Returns "measured by a sensor", "computed from throttle" or "unknown".
std::string_view to_string(CurrentOrigin origin);

/// Unusable lines or values of one reason, by time; in binary logs frames, or bytes between them. A line without a time
/// gets that of the next message, or an infinite time after the last message.
struct SkippedLines {
    enum class Unit { line, frame, byte };
    struct AtTime {
        double time_s = 0.0;
        std::size_t count = 0;
        std::size_t first_line = 0;  ///< in a binary log the first byte, also counted from 1
        bool operator==(const AtTime&) const = default;
    };
    std::string reason;
    std::vector<AtTime> lines;  ///< in order of time, which rises strictly
    Unit unit = Unit::line;

    /// Returns their number.
    std::size_t count() const;
    /// Returns the first line (of a binary log: byte); 0 without any.
    std::size_t first_line() const;
    bool operator==(const SkippedLines&) const = default;
};

/// Returns "line", "frame" or "byte".
std::string_view to_string(SkippedLines::Unit unit);

/// Returns whether all are at the end and as few as in a log that is cut off at power-off: a line, a frame, or the
/// bytes of one block of a card after the last message.
bool is_partial_record(const SkippedLines& skipped);

/// Returns "ENERGY: another number of fields than the .log defines: 3 lines, first at line 17"; for a binary log
/// "damaged: 3 bytes, first at byte 1201".
std::string describe(const SkippedLines& skipped);

/// An assumption about a message: its layout, as there is no .log, or a unit, as the .log has none or an unknown one.
struct AssumedDefinition {
    std::string text;      ///< "ENERGY: 2018 (6 fields)", "POWER_DEVICE: current has no unit: A is assumed"
    double since_s = 0.0;  ///< time from which the assumption was needed
    bool operator==(const AssumedDefinition&) const = default;
};

}  // namespace flightwatt::telemetry
