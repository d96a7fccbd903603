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

/// Whether lines come in as fast as their clock goes, as over a link, and not a log at once or in bursts: over the last
/// half a minute to a minute their times and their arrivals went on together.
class ArrivalMonitor {
  public:
    static constexpr double window_s = 30.0;
    static constexpr double max_spread_s = 3.0;

    /// A line that is believed, both on clocks in seconds.
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

    /// Of the last line; none where that is not known, or the two do not go together.
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

    std::optional<double> begin_s_;  ///< of the window that `now_` is of
    Lag now_;
    std::optional<Lag> before_;  ///< of the window before
    double arrival_s_ = 0.0;
};

/// Accepts or holds the times that come in (docs/live.md). A time more than 10 s off the latest counts when four more
/// agree with it: forwards as a gap, a minute or more backwards as a restart, by less backwards as a clock that goes on
/// from where it was. A clock more than 10 s further ahead than the arrivals was set; it goes on by the arrivals.
class ClockFilter {
  public:
    static constexpr double max_step_s = 60.0;
    static constexpr double max_off_s = 10.0;
    static constexpr std::size_t min_confirmations = 5;
    static constexpr double late_s = 2.0;

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
    void set_held_back(double by_s);
    double set_ahead_of_arrivals_s() const;
    void accept_line(Line line, std::vector<Line>& accepted);

    bool started_ = false;
    bool is_guess_ = false;  ///< `latest_s_`, of no line
    double latest_s_ = 0.0;
    double offset_s_ = 0.0;
    std::vector<Line> held_;
    std::size_t unconfirmed_ = 0;
    std::size_t steps_back_ = 0;
    ArrivalMonitor pace_;
    double set_ahead_s_ = 0.0;
};

/// A clock for each sender: what is wrong with one says nothing of the others. One of them is followed, and its clock
/// is the telemetry's.
class SenderClocks {
  public:
    static constexpr std::size_t max_senders = 32;  ///< those beyond share one

    enum class RestartScope { none, sender, all };

    /// Takes a line, and appends those that are believed now. Whether the clock of their sender began anew before them,
    /// or all did: `restarted` says that the source of the line began anew, so that no other lines have to agree.
    RestartScope push(ClockFilter::Line line, bool restarted, std::vector<ClockFilter::Line>& believed);
    /// Nothing more will come.
    void flush(std::vector<ClockFilter::Line>& believed);

    /// From now on the clock is this sender's, once it has sent; until then that of the first who did.
    void follow(const std::string& sender);
    /// Whether a sender's clock is the one that counts.
    bool is_followed(std::string_view sender) const { return sender == followed_; }

    bool started() const { return !clocks_.empty(); }
    /// The followed sender's latest time, and what the others' clocks have gone on since.
    double latest_s() const;
    /// For how long others, but not the followed sender, have sent.
    double silent_s() const { return others_s_; }
    std::size_t unconfirmed() const;
    /// Of the followed sender.
    std::size_t steps_back() const;
    double set_ahead_s() const;

  private:
    struct Clock {
        ClockFilter filter;
        std::size_t round = 0;  ///< of the followed sender's lines
        double begin_s = 0.0;   ///< of this sender's first line in that round
    };
    using Clocks = std::map<std::string, Clock, std::less<>>;

    Clock& clock_of(std::string_view sender);
    void advance(std::string_view sender, bool anew, Clock& clock);

    Clocks clocks_;
    std::string followed_;
    std::size_t round_ = 1;
    double others_s_ = 0.0;
    std::size_t unconfirmed_before_ = 0;  ///< of clocks that are gone
};

/// The sender of a line without its time: its first word.
std::string_view sender_of(std::string_view text);

}  // namespace flightwatt::live
