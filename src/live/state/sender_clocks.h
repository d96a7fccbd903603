#pragma once

#include "live/state/clock_filter.h"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

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
