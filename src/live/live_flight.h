#pragma once

#include "flight/flight_phases.h"
#include "live/live_schedule.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "live/turn_home.h"
#include "telemetry/log_configuration.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// How a flight is watched.
struct LiveOptions {
    std::string flight = "live";                                    ///< its name
    std::optional<std::string> aircraft_id = {};                    ///< none: the one that flies
    std::optional<telemetry::LogConfiguration> configuration = {};  ///< definitions; none: the built-in ones
    double silence_threshold_s = 30.0;                              ///< after which the link is called silent
    /// Called with every .data line that is believed, in their order; `clock_restarted`: the clock began anew before
    /// them.
    std::function<void(std::string_view lines, bool clock_restarted)> on_lines = {};
    std::size_t most_rows = 30'000;  ///< of messages, kept in memory
};

struct Alarm {
    std::string kind;  ///< "reserve", "model", "silence" or "voltage"
    std::string text;
};

/// What is known of the battery.
struct LiveBattery {
    std::optional<double> soc_percent;             ///< its charge at the start less what was drawn
    std::optional<double> soc_by_voltage_percent;  ///< as the battery model tells it from voltage and current
    double initial_soc_percent = 0.0;
    bool initial_is_from_voltage = false;             ///< by the resting voltage
    std::optional<double> drawn_ah;                   ///< since the first message that is kept
    std::optional<double> voltage_residual_v;         ///< measured less the model's, median of the last minute
    std::optional<double> time_to_reserve_s;          ///< so long could a cruise go on until only the reserve is left
    std::optional<double> probability_below_reserve;  ///< of landing below the reserve, 0 to 1
    std::optional<battery::BatteryState> state;       ///< what the forecasts start from
};

/// All that is known at a moment of a flight.
struct LiveState {
    double time_s = 0.0;                               ///< of the latest message, on the clock of the telemetry
    std::string aircraft_id;                           ///< empty: none is known yet
    std::string aircraft_name;                         ///< as the .log has it
    std::map<std::string, std::size_t> other_senders;  ///< messages of other senders

    std::optional<flight::Phase> phase;  ///< none: on the ground
    std::size_t sortie = 0;              ///< since the watch began; 0: none yet
    bool began_in_air = false;           ///< what was flown before the first message is not known
    bool landed = false;
    std::optional<double> lift_off_s;
    double flight_time_s = 0.0;  ///< in the air, or since the first message there
    double phase_time_s = 0.0;   ///< in the phase
    std::optional<double> energy_wh;

    std::optional<double> power_w;
    std::optional<double> voltage_v;
    std::optional<double> current_a;
    std::optional<double> altitude_m;
    std::optional<double> expected_power_w;  ///< of what comes next, as predicted; else the cruise's so far

    std::optional<LiveBattery> battery;
    std::optional<Prediction> prediction;
    std::string no_prediction_reason;  ///< why there is none
    std::optional<ReturnDeadline> turn_home;
    std::optional<LiveDecision> decision;

    std::vector<Alarm> alarms;
    std::vector<std::string> warnings;  ///< of the battery's file, the record and the prediction
    std::size_t messages = 0;
    std::size_t restarts = 0;  ///< of the clock
    double time_since_message_s = 0.0;
    std::map<std::string, std::size_t> unusable;  ///< lines and values by reason
    std::size_t rows = 0;                         ///< kept
};

/// A flight that is in the air, from its messages as they come in. Memory is bounded: what lies before the rest before
/// the last lift-off goes first, then every second row of the message that has most (docs/live.md). Nothing that comes
/// in makes it throw.
class LiveFlight {
  public:
    LiveFlight(LiveOptions options, std::optional<PredictionInput> basis, std::unique_ptr<LiveSchedule> schedule);
    ~LiveFlight();

    /// Takes a message; `arrival_s` is its time if its source has none, and tells a clock that was set ahead from a gap
    /// where it goes on as the times do.
    void receive(IncomingMessage message, double arrival_s);
    /// The time of the latest message that is believed; none before the first.
    std::optional<double> clock_s() const;
    /// No more messages will come.
    void end();

    /// What is known now. `time_since_message_s`: for how long nothing has come.
    LiveState update(double silent_s = 0.0);
    /// The last state that had a prediction; none before.
    const std::optional<LiveState>& last_predicted() const;

  private:
    class Impl;
    std::unique_ptr<Impl> watch_;
};

}  // namespace flightwatt::live
