#pragma once

#include "live/source.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// From the thread that a source receives in to the one that asks for messages. What is not fetched is kept up to a
/// bound; then the oldest are dropped, and counted.
class MessageQueue {
  public:
    static constexpr std::size_t max_waiting = 100'000;  ///< of a lively link an hour or more
    static constexpr std::size_t max_per_call = 4'000;

    /// Messages without a time of their own get that of their arrival, since now, times `clock_factor`.
    explicit MessageQueue(double clock_factor);

    void push(IncomingMessage message);
    void count(std::string_view reason, std::size_t times = 1);
    /// The link began anew. Its clock, too? Then the next message says so.
    void count_restart(bool new_clock);

    /// Waits for messages, at most so long, and appends them; `report` becomes what was counted until now.
    void take(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages, SourceReport& report);

  private:
    const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
    const double clock_factor_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<IncomingMessage> waiting_;
    SourceReport report_;
    bool after_restart_ = false;
};

}  // namespace flightwatt::live
