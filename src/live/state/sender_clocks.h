#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::live {

/// Whether lines arrive at the pace of their own times, as over a link, and not at once or in bursts: tested over the
/// last 30 to 60 s.
class ArrivalMonitor {
  public:
    static constexpr double window_s = 30.0;
    static constexpr double max_spread_s = 3.0;

    void add(double time_s, double arrival_s) {
        const double lag_s = arrival_s - time_s;
        if (!begin_s_ || time_s > *begin_s_ + window_s) {
            before_ = begin_s_ ? std::optional(now_) : std::nullopt;
            now_ = {lag_s, lag_s};
            begin_s_ = time_s;
        }
        now_ = {std::min(now_.min_s, lag_s), std::max(now_.max_s, lag_s)};
        arrival_s_ = arrival_s;
    }

    /// Arrival of the last line; none where the pace differs or is not known yet.
    std::optional<double> last_arrival_s() const {
        if (!before_) return std::nullopt;
        const double spread_s = std::max(before_->max_s, now_.max_s) - std::min(before_->min_s, now_.min_s);
        return spread_s < max_spread_s ? std::optional(arrival_s_) : std::nullopt;
    }

  private:
    struct Lag {
        double min_s = 0.0;
        double max_s = 0.0;
    };

    std::optional<double> begin_s_;  ///< of the current window
    Lag now_;
    std::optional<Lag> before_;  ///< of the previous window
    double arrival_s_ = 0.0;
};

/// Accepts, corrects or holds the times of one sender:
/// - within 10 s of the latest: accepted;
/// - otherwise held until five lines agree; then
///   - forwards: a gap, or where the clock ran more than 10 s ahead of the arrivals, a clock that was set;
///   - backwards by a minute or more: a restart;
///   - backwards by less: a clock that was set back. A clock that was set is corrected, so that time continues.
class ClockFilter {
  public:
    static constexpr double max_step_s = 60.0;
    static constexpr double max_off_s = 10.0;
    static constexpr std::size_t min_confirmations = 5;
    static constexpr double late_s = 2.0;

    struct Line {
        double time_s = 0.0;                   ///< once accepted: corrected
        std::string text;                      ///< without the time
        std::optional<double> arrival_s = {};  ///< on a clock that is never set; none where it is not meaningful
        std::vector<double> values = {};       ///< of the fields, where `text` has none
    };

    /// Takes a line and appends the accepted ones. True where they are the first after a restart.
    bool push(Line line, std::vector<Line>& accepted);
    bool is_late(double time_s) const { return started_ && time_s + offset_s_ < latest_s_ - late_s; }
    /// At the end of the telemetry: accepts held lines that are ahead of the latest.
    void flush(std::vector<Line>& accepted);

    std::size_t unconfirmed() const { return unconfirmed_; }
    std::size_t steps_back() const { return steps_back_; }
    /// [s] by which the clock was set ahead, in all.
    double set_ahead_s() const { return set_ahead_s_; }
    double latest_s() const { return latest_s_; }

  private:
    bool hold(Line line, std::vector<Line>& accepted);
    void shift_held(double back_s);
    double set_ahead_of_arrivals_s() const;
    void accept_line(Line line, std::vector<Line>& accepted);

    bool started_ = false;
    double latest_s_ = 0.0;
    double offset_s_ = 0.0;
    std::vector<Line> held_;
    std::size_t unconfirmed_ = 0;
    std::size_t steps_back_ = 0;
    ArrivalMonitor pace_;
    double set_ahead_s_ = 0.0;
};

/// A clock filter for each sender, so that an error of one does not affect the others. The clock of the followed sender
/// is that of the telemetry.
class SenderClocks {
  public:
    static constexpr std::size_t max_senders = 32;  ///< further ones share a filter

    enum class RestartScope { none, sender, all };

    /// Takes a line and appends the accepted ones. Returns which clocks restarted before them. `source_restarted`: a
    /// late line is a restart of all, without confirmation.
    RestartScope push(ClockFilter::Line line, bool source_restarted, std::vector<ClockFilter::Line>& accepted);
    /// At the end of the telemetry.
    void flush(std::vector<ClockFilter::Line>& accepted);

    /// Follows a sender once it has sent; before the first call, the first sender.
    void follow(const std::string& sender);
    bool is_followed(std::string_view sender) const { return sender == followed_; }

    bool started() const { return !clocks_.empty(); }
    /// The followed sender's latest time, advanced by the others' clocks since.
    double latest_s() const { return followed_clock().latest_s() + others_s_; }
    /// Time since the followed sender's last line, by the others' clocks.
    double silent_s() const { return others_s_; }
    std::size_t unconfirmed() const;
    /// Of the followed sender.
    std::size_t steps_back() const { return followed_clock().steps_back(); }
    double set_ahead_s() const { return followed_clock().set_ahead_s(); }

  private:
    struct Clock {
        ClockFilter filter = {};
        std::optional<double> begin_s = {};  ///< of the first line since the followed sender's last one
    };

    Clock& clock_of(std::string_view sender);
    const ClockFilter& followed_clock() const;
    void advance(std::string_view sender, bool restarted, Clock& clock);
    void reset_silence();

    std::map<std::string, Clock, std::less<>> clocks_;
    std::string followed_;
    double others_s_ = 0.0;
    std::size_t unconfirmed_before_ = 0;  ///< of removed clocks
};

/// The sender of a line without its time: its first word.
std::string_view sender_of(std::string_view text);

}  // namespace flightwatt::live
