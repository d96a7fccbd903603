#pragma once

#include "live/sources.h"

#include <cstddef>
#include <vector>

namespace flightwatt::live {

/// Accepts, corrects or holds the times of one sender, so that an error of one does not affect the others:
/// - within 10 s of the latest: accepted;
/// - otherwise held until five lines agree; then
///   - forwards: a gap; by more than ten minutes a restart, as the clock may have been set;
///   - backwards by a minute or more: a restart;
///   - backwards by less: a clock that was set back, which is corrected, so that time continues.
class ClockFilter {
  public:
    static constexpr double max_step_s = 60.0;
    static constexpr double max_off_s = 10.0;
    static constexpr double max_gap_s = 600.0;
    static constexpr std::size_t min_confirmations = 5;
    static constexpr double late_s = 2.0;

    /// Takes a message with a time and appends the accepted ones. True where they are the first after a restart.
    bool push(IncomingMessage message, std::vector<IncomingMessage>& accepted);
    bool is_late(double time_s) const { return started_ && time_s + offset_s_ < latest_s_ - late_s; }
    /// At the end of the telemetry: accepts held messages that are ahead of the latest.
    void flush(std::vector<IncomingMessage>& accepted);

    std::size_t unconfirmed() const { return unconfirmed_; }
    std::size_t steps_back() const { return steps_back_; }
    double latest_s() const { return latest_s_; }

  private:
    bool hold(IncomingMessage message, std::vector<IncomingMessage>& accepted);

    bool started_ = false;
    double latest_s_ = 0.0;
    double offset_s_ = 0.0;
    std::vector<IncomingMessage> held_;
    std::size_t unconfirmed_ = 0;
    std::size_t steps_back_ = 0;
};

}  // namespace flightwatt::live
