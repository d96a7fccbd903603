#pragma once

#include "battery/battery.h"
#include "flight/flight_phases.h"
#include "live/live_schedule.h"
#include "live/prediction.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::live {

/// A warning for the pilot about the flight.
struct LiveAlarm {
    std::string kind;    ///< "reserve", "model", "silence" or "voltage"
    std::string grade;   ///< "caution" or "alarm"
    std::string text;    ///< the finding
    std::string action;  ///< recommended, with the time left
};

/// The state of the battery, by charge and by voltage.
struct LiveBattery {
    std::optional<double> soc_percent;                ///< the initial one less the charge drawn
    std::optional<double> soc_by_voltage_percent;     ///< by the battery's model from voltage and current
    double soc_by_voltage_sd_percent = 0.0;           ///< its standard deviation [points]
    InitialCharge initial;                            ///< or the current one, where only the voltage shows it
    std::optional<double> drawn_ah;                   ///< charge drawn since the first retained message
    std::optional<double> voltage_residual_v;         ///< measured less the model's, median of the last minute
    double voltage_explained_v = 0.0;                 ///< of it by a resistance as in 95 of 100 flights
    std::optional<double> time_to_reserve_s;          ///< time until the reserve is reached in a continued cruise
    std::optional<double> probability_below_reserve;  ///< probability of landing below the reserve, 0 to 1
    std::optional<battery::BatteryState> state;       ///< state for forecasts
    bool is_by_voltage = false;  ///< `state` is by the voltage, which shows less than the charge drawn
};

/// The state of a flight in progress at a moment.
struct LiveState {
    double time_s = 0.0;                               ///< time of the latest message, on the clock of the telemetry
    std::string aircraft_id;                           ///< empty: none yet
    std::string aircraft_name;                         ///< from the .log
    std::map<std::string, std::size_t> other_senders;  ///< ids of other senders, with their numbers of messages

    std::optional<flight::Phase> phase;  ///< none: on the ground
    std::size_t sortie = 0;              ///< number of the sortie since following began; 0: none yet
    bool began_in_air = false;           ///< the flight before the first message is unknown
    bool landed = false;
    std::optional<double> lift_off_s;
    double flight_time_s = 0.0;  ///< in the air, or since the first message there
    double phase_time_s = 0.0;   ///< since the phase began
    std::optional<double> energy_wh;

    std::optional<double> power_w;
    std::optional<double> voltage_v;
    std::optional<double> current_a;
    std::optional<double> altitude_m;
    std::optional<double> expected_power_w;  ///< power of the next load, as predicted; else the mean of the cruise

    std::optional<LiveBattery> battery;
    std::optional<Prediction> prediction;
    std::string no_prediction_reason;
    std::optional<ReturnDeadline> turn_home;
    std::optional<LiveDecision> decision;

    std::vector<LiveAlarm> alarms;
    std::vector<std::string> warnings;  ///< about the battery's file, the record and the prediction
    std::size_t messages = 0;
    std::size_t restarts = 0;  ///< restarts of the clock
    double time_since_message_s = 0.0;
    double time_without_power_s = 0.0;            ///< in the air, since the last power, if too long; else 0
    double silence_threshold_s = 0.0;             ///< time_since_message_s above which the link counts as lost
    std::optional<double> reserve_soc_percent;    ///< reserve of the mission
    std::map<std::string, std::size_t> unusable;  ///< number of unusable lines and values, by reason
    std::size_t rows = 0;                         ///< messages in memory
};

}  // namespace flightwatt::live
