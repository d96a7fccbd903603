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
/// time. While an aircraft itself is on the bus replays are ignored: there is one clock.
class IvyMessages {
  public:
    explicit IvyMessages(MessageSink& sink) : sink_(sink) {}

    void handle(std::string_view text);
    /// Nothing more will come: forwards what waits for its time.
    void release();

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
};

}  // namespace flightwatt::live
