#pragma once

#include <optional>
#include <string_view>

namespace flightwatt {

/// A time as a clock shows it.
struct ClockTime {
    double time_s = 0.0;  ///< since 1970 (UTC where no zone is stated), without a date since midnight
    bool has_date = false;
    bool has_time = false;  ///< of the day
};

/// Reads "10:17:15.060", "2026-01-02", "2026-01-02 10:17:15", "2026-01-02T10:17:15.060+01:00" (ISO 8601, also with
/// slashes), "10:17:15 AM" (of 12 hours). std::nullopt for anything else.
std::optional<ClockTime> parse_clock_time(std::string_view text);

/// A column of times: numbers, or times of a clock, which begin at 0 and may pass midnight.
class TimeColumn {
  public:
    /// `tick_s`: the unit of numbers; `is_unix`: they count from 1970, and begin at 0 too.
    explicit TimeColumn(double tick_s = 1.0, bool is_unix = false) : tick_s_(tick_s), is_unix_(is_unix) {}

    /// Seconds of the log; std::nullopt for a cell that is no time, or of another kind than the first. `date`: the day
    /// of a time without one.
    std::optional<double> read(std::string_view cell, std::string_view date = {});
    /// Whether the times are of a clock; false for numbers.
    bool is_clock() const { return is_clock_; }
    /// Unix time of second 0 (UTC where no zone is stated), if the first row states it.
    std::optional<double> start_clock_s() const { return start_clock_s_; }

  private:
    void start(double first_s, std::optional<double> date_s);

    double tick_s_;
    bool is_unix_;
    bool has_started_ = false;
    bool is_clock_ = false;
    double zero_s_ = 0.0;
    double last_s_ = 0.0;  ///< before zero_s_ is subtracted
    std::optional<double> start_clock_s_;
};

}  // namespace flightwatt
