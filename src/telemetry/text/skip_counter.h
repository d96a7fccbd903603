#pragma once

#include "telemetry/log_notes.h"
#include "telemetry/text/line_scanner.h"

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::telemetry {

enum class SkipReason {
    not_a_message,
    no_time,
    other_field_count,
    unknown_message,
    not_a_number,
    // of binary logs
    damage,           ///< detail: 1 if the log is cut off there
    undefined_frame,  ///< detail: class and message
    frame_of_another_length,
};

struct SkipKind {
    SkipReason reason;
    std::size_t detail;  ///< plan, and field for not_a_number
    bool operator==(const SkipKind&) const = default;
};

/// Counts lines that cannot be used, by kind and time, so that a log that is cut later is counted as if it had
/// been cut before. Memory grows with the different times alone. Part of parse_telemetry.
class SkipCounter {
  public:
    explicit SkipCounter(std::string_view text) : text_(text) {}

    void add(const SkipKind& kind, double time_s, std::size_t line_number, std::size_t count = 1);
    /// A line without a time counts to the next one in the text that has one. Fast in the order of the text.
    void add_without_time(const SkipKind& kind, const ScannedLine& line);

    /// Adds what was counted in a later part of the same text, which begins behind `lines_before` lines.
    void append(const SkipCounter& later, std::size_t lines_before);

    /// What was counted, by first line. `reason` is left empty.
    std::vector<std::pair<SkipKind, SkippedLines>> take();

  private:
    double time_behind_s(const char* line_end);

    std::string_view text_;
    std::vector<std::pair<SkipKind, SkippedLines>> skips_;
    const char* searched_from_ = nullptr;  ///< from here to there no line has a time
    const char* searched_to_ = nullptr;
    double found_s_ = 0.0;
};

}  // namespace flightwatt::telemetry
