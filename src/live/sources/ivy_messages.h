#pragma once

#include "live/source.h"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// Telemetry out of what is said on an Ivy bus. An aircraft's messages are handed on at once; they have no time. What
/// Paparazzi's log player says, "replay20 ENERGY ..." and after it "time20 13.9", becomes the message with its time,
/// which is handed on with that time or, where none follows, with release(). While an aircraft
/// itself is on the bus no replay is heeded: there is one clock.
class IvyMessages {
  public:
    using Sink = std::function<void(IncomingMessage)>;

    explicit IvyMessages(Sink sink) : sink_(std::move(sink)) {}

    void handle(std::string_view said);
    /// What was said until now has been waited for long enough: no time follows.
    void release();
    bool has_pending() const;

    /// How often a time was said.
    std::size_t times() const { return times_; }
    std::size_t ignored_replays() const { return unheeded_replays_; }
    /// Lines of one word or none.
    std::size_t malformed_lines() const { return no_messages_; }

  private:
    struct Replay {
        std::optional<double> time_s;  ///< the last that was said
        std::vector<std::string> waiting;
    };

    void hand_on(Replay& replay);

    Sink sink_;
    std::map<std::string, Replay, std::less<>> replays_;  ///< by aircraft
    std::optional<double> latest_time_s_;                 ///< of any replay
    bool has_aircraft_ = false;                           ///< itself is on the bus
    std::size_t times_ = 0, unheeded_replays_ = 0, no_messages_ = 0;
};

}  // namespace flightwatt::live
