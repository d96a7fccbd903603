#pragma once

#include "live/sources/message_readers.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// Telemetry out of the texts on an Ivy bus. An aircraft's messages are forwarded at once; they have no time.
/// Paparazzi's log player sends "replay20 ENERGY ..." and after it "time20 13.9": this becomes the message with its
/// time, which is forwarded with that time or, where none follows, by release(). While an aircraft itself is on the bus
/// replays are ignored: there is one clock.
class IvyMessages {
  public:
    explicit IvyMessages(MessageSink& sink) : sink_(sink) {}

    void handle(std::string_view text);
    /// Messages have waited long enough: no time follows.
    void release();
    bool has_pending() const;

    /// How many times came.
    std::size_t times() const { return times_; }

  private:
    struct Replay {
        std::optional<double> time_s;  ///< the latest
        std::vector<std::string> waiting;
    };

    void handle_time(std::string_view id, std::string_view text);
    void forward(Replay& replay);
    void count_malformed() { sink_.count("messages of a single word", 1); }

    MessageSink& sink_;
    std::map<std::string, Replay, std::less<>> replays_;  ///< by aircraft
    std::optional<double> latest_time_s_;                 ///< of any replay
    bool has_aircraft_ = false;                           ///< itself is on the bus
    std::size_t times_ = 0;
};

}  // namespace flightwatt::live
