#pragma once

#include <algorithm>
#include <optional>

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

}  // namespace flightwatt::live
