#pragma once

#include "live/live_schedule.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "telemetry/log_configuration.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

struct LiveOptions {
    std::string flight = "live";                                    ///< its name
    std::optional<std::string> aircraft_id = {};                    ///< none: the one that sends most
    std::optional<telemetry::LogConfiguration> configuration = {};  ///< definitions; none: the built-in ones
    double silence_threshold_s = 30.0;                              ///< of the alarm
    /// Called with the accepted .data lines in their order; `clock_restarted`: before them.
    std::function<void(std::string_view lines, bool clock_restarted)> on_lines = {};
    std::size_t max_rows = 30'000;  ///< of messages in memory
};

/// A flight in progress, updated with its messages. Memory is bounded: rows long before the last lift-off are
/// dropped first, then the largest table is thinned by two (docs/live.md). Invalid input does not throw.
class LiveFlight {
  public:
    LiveFlight(LiveOptions options, std::optional<PredictionInput> input, std::unique_ptr<LiveSchedule> schedule);
    ~LiveFlight();

    /// `arrival_s` is the time of a message without one, and serves to find a silent aircraft while others send.
    void receive(IncomingMessage message, double arrival_s);
    /// Time of the latest accepted message; none before the first.
    std::optional<double> clock_s() const;
    /// No more messages will follow.
    void end();

    /// The current state. `silent_s`: time since the last message of any sender.
    LiveState update(double silent_s = 0.0);
    /// The last state with a prediction; none before.
    const std::optional<LiveState>& last_predicted() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace flightwatt::live
