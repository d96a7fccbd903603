#pragma once

#include "battery/discharge_record.h"
#include "battery/landing_forecast.h"
#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "mission/mission.h"
#include "path/path_tracker.h"
#include "path/remaining_path.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Prediction of the energy from a moment in take-off or cruise to the end of the flight, for predict and watch.
namespace flightwatt::live {

/// The input of a prediction, without the flight itself.
struct PredictionInput {
    mechanical::MechanicalModel model;
    mechanical::CruisePrior prior = mechanical::CruisePrior::curve;
    double takeoff_s = 0.0;
    double landing_s = 0.0;
    flight::PerPhase<std::optional<double>> duration_sd_s = {};  ///< as stated; absent: as of the model's flights
    std::optional<double> remaining_s = {};                      ///< time from now until the landing begins
    std::optional<double> cruise_s = {};  ///< else duration of the whole cruise; absent: that of the path
    std::optional<mechanical::FlightState> motion = {};   ///< motion in the remaining cruise; or
    std::shared_ptr<const path::PathForecast> path = {};  ///< path of the cruise
    std::optional<battery::Battery> battery = {};
    std::string battery_file = {};                   ///< file of the battery, for errors
    std::optional<double> initial_soc_percent = {};  ///< absent: by the resting voltage
    battery::LandingLimits limits = {};
    std::vector<std::string> uncertain = {};  ///< reasons of the mission why what is ahead may take more
    std::string no_prediction_reason = {};    ///< reason why the model allows no prediction; empty if it does
};

/// A state of charge at the beginning of a record.
struct InitialCharge {
    double soc_percent = 0.0;
    double sd_percent = 0.0;  ///< standard deviation of one by the voltage [points]; 0: given
};

/// The battery at a moment.
struct BatteryNow {
    battery::BatteryState state;
    double drawn_ah = 0.0;  ///< since the charge was `initial`
    InitialCharge initial;
};

/// The prediction of the battery at landing.
struct BatteryPrediction {
    battery::LandingForecast expected;
    battery::LandingForecast worst;  ///< at the high end of the energy's interval and the low ends of those of the
                                     ///< capacity and the initial charge, if known
    battery::LandingLimits limits;   ///< limits of the mission
    bool worst_uses_min_capacity = false;  ///< the interval of the capacity is known
    InitialCharge initial;
    bool initial_soc_is_current =
        false;  ///< earlier charge is unknown, or contradicted: `initial` is the current value
};

/// The prediction of a flight from a moment to its end.
struct Prediction {
    mechanical::FlightProgress flown;
    bool began_in_air = false;              ///< the lift-off was not received: `flown` counts from the first message
    std::optional<double> on_path_s = {};   ///< position on the path, as its planned time
    bool is_from_position = false;          ///< `on_path_s` is by the aircraft's positions, not by the time
    path::LocalPosition away = {};          ///< the aircraft from there, once it has left the path
    double takeoff_s = 0.0;                 ///< expected rest of the take-off; 0 in cruise
    mechanical::EnergyEstimate takeoff;     ///< energy of that rest
    double remaining_s = 0.0;               ///< rest of the cruise
    std::optional<double> overtime_s = {};  ///< time of the cruise beyond the mission's: the landing then begins now
    bool uses_physical_model = false;       ///< for the cruise; else the curve of the power
    mechanical::RemainingCruise cruise;
    std::vector<battery::ConstantLoad> remaining_power = {};  ///< planned power along the path; empty: constant
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    double landing_sd_s = 0.0;  ///< standard deviation of `landing_s`; 0 if that is stated
    mechanical::EnergyEstimate remaining_energy;
    Interval interval;  ///< of it [Wh]
    std::optional<BatteryPrediction> battery = {};
};

/// Messages for the user about a prediction.
struct Remarks {
    std::vector<std::string> warnings;
    std::vector<std::string> notes;
};

/// Throws InputError for a model without between-flight variability of a phase, which an interval requires.
void require_interval(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file);

/// Throws InputError for a model without a physical part or its between-flight variability, which `option` requires.
void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option);

/// Returns the state of charge at the start of a record: the given one, else by its resting voltage. The input has a
/// battery. Throws InputError if neither is available (a battery of constant voltage).
InitialCharge initial_charge(const PredictionInput& input, const battery::DischargeRecord& flown);

/// Returns the state of charge at the start of a record by its resting voltage, also if one is given.
InitialCharge initial_charge_by_voltage(const PredictionInput& input, const battery::DischargeRecord& flown);

/// Predicts the remaining flight from its progress and its series until now; of a cruise beyond the mission's, a
/// landing from now. Throws NoResultError if more charge was drawn than available, or an energy below 0 is predicted,
/// UsageError for a remaining time longer than the path, and as mechanical::predict_remaining_flight and
/// battery::discharge_records.
Prediction predict_flight(const PredictionInput& input, const mechanical::FlightProgress& flown,
                          const flight::FlightData& data, Remarks& remarks);

/// Predicts as predict_flight(), without the battery. `fix` is the position on the path; without it, the time since the
/// cruise began gives it.
Prediction predict_energy(const PredictionInput& input, const mechanical::FlightProgress& flown,
                          const std::optional<path::PathFix>& fix, Remarks& remarks);

/// The deviation of the cruise so far from the model.
struct ModelDeviation {
    double fraction = 0.0;  ///< of the half width of the model's 95 % interval
    std::string text;       ///< "the cruise so far took 2.1 Wh; 95 of 100 flights of the model take 4.0 to 5.1 Wh"
};

/// Returns how far the cruise so far deviates from the model; 0 before there is one, or where its interval is unknown.
ModelDeviation model_deviation(const Prediction& prediction, const PredictionInput& input);

/// Returns the expected loads of the remaining take-off, the remaining cruise and the landing, times `factor`.
std::vector<battery::ConstantLoad> remaining_power(const Prediction& prediction, double factor = 1.0);

/// Returns the energy of loads.
double energy_j(const std::vector<battery::ConstantLoad>& loads);

/// Returns the state of the battery if its capacity is another, and its initial charge was `more_percent` higher: from
/// empty to full.
battery::BatteryState state_for(const BatteryNow& now, double nominal_ah, double capacity_ah, double more_percent);

/// Forecasts the battery to the landing.
BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const BatteryNow& now, const Prediction& prediction);

/// The latest moment at which the aircraft must turn home.
struct ReturnDeadline {
    std::optional<double> latest_in_s;  ///< absent: the reserve cannot be kept any more
    bool path_can_be_flown = false;     ///< to its end (or the cruise), and home from there: that is `latest_in_s`
};

/// Returns the latest moment at which the aircraft can leave the path and fly straight home, level, at the path's
/// current airspeed and in the plan's wind (without a path: begin the landing) and keep the reserve at the high end of
/// the energy's interval. A cruise beyond the mission's continues at its mean power. Moments are evaluated every 10 s,
/// at most 40. The input has a battery, whose state is `now`.
ReturnDeadline latest_return(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now);

/// A curve over time.
struct TimeCurve {
    std::vector<double> time_s;  ///< on the telemetry's clock
    std::vector<double> value;
};

/// Predicts the state of charge [%] from `now_s` to the landing, or until the battery fails, at up to about a hundred
/// points. The input has a battery.
TimeCurve predict_soc_curve(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now,
                            double now_s);

/// Returns the input by a mission with a mechanical model: model, path or duration of the cruise, battery (its capacity
/// as uncertain as in the mission's drawn flights) and limits; with `no_prediction_reason` if its model allows no
/// prediction. `file` is the mission's, for errors. Throws InputError for an infeasible path.
PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// Returns the input by a mission as input_from_mission(), without the battery. Throws InputError if the model allows
/// no prediction.
PredictionInput energy_input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// Returns the input by a model alone: `remaining_s` more of the cruise from any moment, then the model's landing.
/// Throws as require_interval.
PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s);

}  // namespace flightwatt::live
