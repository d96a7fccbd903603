#pragma once

#include "flight/flight_phases.h"
#include "live/live_schedule.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "telemetry/log_configuration.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <flightwatt/predictor.h>

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

struct LiveBattery {
    std::optional<double> soc_percent;             ///< the initial one less the charge drawn
    std::optional<double> soc_by_voltage_percent;  ///< by the battery model from voltage and current
    double initial_soc_percent = 0.0;
    bool initial_is_from_voltage = false;             ///< by the resting voltage
    std::optional<double> drawn_ah;                   ///< since the first retained message
    std::optional<double> voltage_residual_v;         ///< measured less the model's, median of the last minute
    std::optional<double> time_to_reserve_s;          ///< of a continued cruise
    std::optional<double> probability_below_reserve;  ///< at landing, 0 to 1
    std::optional<battery::BatteryState> state;       ///< for forecasts
};

/// The state of a flight at a moment.
struct LiveState {
    double time_s = 0.0;                               ///< of the latest message, on the clock of the telemetry
    std::string aircraft_id;                           ///< empty: none yet
    std::string aircraft_name;                         ///< from the .log
    std::map<std::string, std::size_t> other_senders;  ///< with their numbers of messages

    std::optional<flight::Phase> phase;  ///< none: on the ground
    std::size_t sortie = 0;              ///< number since the watch began; 0: none yet
    bool began_in_air = false;           ///< the flight before the first message is unknown
    bool landed = false;
    std::optional<double> lift_off_s;
    double flight_time_s = 0.0;  ///< in the air, or since the first message there
    double phase_time_s = 0.0;   ///< in the phase
    std::optional<double> energy_wh;

    std::optional<double> power_w;
    std::optional<double> voltage_v;
    std::optional<double> current_a;
    std::optional<double> altitude_m;
    std::optional<double> expected_power_w;  ///< of the next load, as predicted; else the mean of the cruise

    std::optional<LiveBattery> battery;
    std::optional<Prediction> prediction;
    std::string no_prediction_reason;
    std::optional<ReturnDeadline> turn_home;
    std::optional<LiveDecision> decision;

    std::vector<Alarm> alarms;
    std::vector<std::string> warnings;  ///< of the battery's file, the record and the prediction
    std::size_t messages = 0;
    std::size_t restarts = 0;  ///< of the clock
    double time_since_message_s = 0.0;
    double silence_threshold_s = 0.0;             ///< above: the link counts as lost
    std::optional<double> reserve_soc_percent;    ///< of the mission
    std::map<std::string, std::size_t> unusable;  ///< lines and values by reason
    std::size_t rows = 0;                         ///< in memory
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
