#pragma once

#include "telemetry/log_notes.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace flightwatt::telemetry {

/// Reasons why a line, a frame or a value is not used.
enum class SkipReason {
    not_a_message,
    no_time,
    other_field_count,
    unknown_message,
    not_a_number,
    // in binary logs:
    damage,           ///< detail: 1 if the log is cut off there
    undefined_frame,  ///< detail: class and message
    frame_of_another_length,
};

/// A reason, and the message or field that it is about.
struct SkipKind {
    SkipReason reason;
    std::size_t detail;  ///< index of the message's plan, with the field for not_a_number
    bool operator==(const SkipKind&) const = default;
};

/// Counts unusable lines by kind and time, so that truncating the counts at a time gives those of the truncated log.
/// Memory grows with the number of distinct times.
class SkipCounter {
  public:
    /// Counts `count` lines at a time.
    void add(const SkipKind& kind, double time_s, std::size_t line_number, std::size_t count = 1);
    /// Counts a line without a time; it gets the time of the next line that has one.
    void add_without_time(const SkipKind& kind, std::size_t line_number);
    bool waits_for_time() const { return !untimed_.empty(); }
    /// Assigns a time to the lines that wait for one.
    void set_time(double time_s);

    /// Returns the counts, in order of the first line, with an empty `reason`. Lines that still wait for a time get an
    /// infinite one.
    std::vector<std::pair<SkipKind, SkippedLines>> take();

  private:
    using Counts = std::vector<std::pair<SkipKind, SkippedLines>>;

    static SkippedLines& lines_of(Counts& counts, const SkipKind& kind);

    Counts skips_;
    Counts untimed_;  ///< one entry for each kind, without a time
};

}  // namespace flightwatt::telemetry
