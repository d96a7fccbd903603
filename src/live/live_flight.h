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

#include <flightwatt/predictor.h>

namespace flightwatt::live {

/// Options of following a flight.
struct LiveOptions {
    std::string flight = "live";                                    ///< name of the flight
    std::optional<std::string> aircraft_id = {};                    ///< absent: the first that flies
    std::optional<telemetry::LogConfiguration> configuration = {};  ///< definitions; absent: the built-in ones
    bool is_mavlink = false;                                        ///< the messages are MAVLink's
    double silence_threshold_s = 30.0;  ///< time without a message after which there is an alarm
    /// Called with the accepted .data lines in their order (of MAVLink the entries of a .tlog), with whether the clock
    /// restarted before them.
    std::function<void(std::string_view lines, bool clock_restarted)> on_lines = {};
    std::size_t max_rows = 30'000;  ///< maximum number of messages in memory
};

/// A flight in progress, updated with its messages. Memory is bounded: rows long before the last lift-off are
/// dropped first, then the largest table is thinned by two (docs/live.md). Invalid input does not throw.
class LiveFlight {
  public:
    /// Follows a flight; predictions need `input`, decisions about the software `schedule` (may be null).
    LiveFlight(LiveOptions options, std::optional<PredictionInput> input, std::unique_ptr<LiveSchedule> schedule);
    ~LiveFlight();

    /// Predicts by another input from now on: the aircraft's mission became known.
    void set_input(PredictionInput input);
    /// Adds a message. `arrival_s` is its time if it has none, and shows that one aircraft is silent while others send.
    void receive(IncomingMessage message, double arrival_s);
    /// Returns the time of the latest accepted message; std::nullopt before the first.
    std::optional<double> clock_s() const;
    /// States that no more messages will follow.
    void end();

    /// Computes the current state. `silent_s` is the time since the last message of any sender.
    LiveState update(double silent_s = 0.0);
    /// Returns the last state with a prediction; std::nullopt before the first.
    const std::optional<LiveState>& last_predicted() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace flightwatt::live
