#pragma once

#include "live/state/receipt_pace.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::live {

/// What to believe of the times that come in. A time more than 10 s ahead of the latest one, or a minute behind it,
/// counts when four more behind it agree (a single one is a damaged line): forwards it is a gap, backwards the log or
/// the aircraft began anew. Ten lines in a row more than 2 s behind the latest say that the clock went back: it goes on
/// from where it was, unless within a minute a line is ahead by as much: then the lines only came out of order; or,
/// where fewer than five lines had come near the latest, that the latest was damaged. Where lines arrive as fast as
/// their clock goes, a clock that runs more than 10 s further ahead than the arrivals was set: it goes on after as long
/// as nothing arrived.
class ClockFilter {
  public:
    static constexpr double max_step_s = 60.0;
    static constexpr double max_ahead_s = 10.0;
    static constexpr std::size_t min_confirmations = 5;
    static constexpr double late_s = 2.0;
    static constexpr std::size_t late_lines = 10;

    struct Line {
        double time_s = 0.0;                   ///< when accepted: on a clock that never goes back
        std::string text;                      ///< behind the time
        std::optional<double> arrival_s = {};  ///< on a clock that is never set; none where it is of no use
        std::vector<double> values = {};       ///< of the fields, where `text` has none
    };

    ClockFilter() = default;
    /// Of a sender whose clock is thought to be near that time: further lines show whether it is.
    explicit ClockFilter(double about_s) : started_(true), is_guess_(true), latest_s_(about_s) {}

    /// Takes a line, and appends those that are believed now. True where the first of them belongs to a clock that
    /// began anew.
    bool push(Line line, std::vector<Line>& accepted);
    /// Whether a line of that time would be late.
    bool is_late(double time_s) const { return started_ && time_s + offset_s_ < latest_s_ - late_s; }
    /// Nothing more will come: what was held ahead of the latest is believed.
    void flush(std::vector<Line>& accepted);

    std::size_t unconfirmed() const { return unconfirmed_; }
    std::size_t steps_back() const { return steps_back_; }
    /// [s] by which the clock was set ahead, in all.
    double set_ahead_s() const { return set_ahead_s_; }
    bool started() const { return started_; }
    double latest_s() const { return latest_s_; }

  private:
    bool hold(Line line, std::vector<Line>& accepted);
    void handle_late_line(Line& line);
    void handle_recovery(Line& line);
    void undo_step();
    void accept_line(Line line, std::vector<Line>& accepted);

    bool started_ = false;
    bool is_guess_ = false;  ///< `latest_s_`, of no line
    double latest_s_ = 0.0;
    double offset_s_ = 0.0;
    std::size_t late_ = 0;
    std::size_t near_latest_ = 0;  ///< lines since it was reached that are not late
    std::vector<Line> held_;
    std::size_t unconfirmed_ = 0;
    std::size_t steps_back_ = 0;
    double stepped_back_s_ = 0.0;  ///< by the last step, as long as it may have been none
    double stepped_at_s_ = 0.0;
    ArrivalMonitor pace_;
    double set_ahead_s_ = 0.0;
};

}  // namespace flightwatt::live
