#pragma once

#include "battery/discharge_record.h"
#include "battery/landing_forecast.h"
#include "mechanical/flight_progress.h"
#include "mechanical/prediction.h"
#include "mission/mission.h"
#include "path/path_tracker.h"
#include "path/remaining_path.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Prediction of the energy from a moment in take-off or cruise to the end of the flight, for predict and watch.
namespace flightwatt::live {

/// The inputs of a prediction, except for the flight itself.
struct PredictionInput {
    mechanical::MechanicalModel model;
    mechanical::CruisePrior prior = mechanical::CruisePrior::curve;
    double takeoff_s = 0.0;
    double landing_s = 0.0;
    flight::PerPhase<std::optional<double>> duration_sd_s = {};  ///< as stated; none: as the model's flights differ
    std::optional<double> remaining_s = {};                      ///< until the landing begins, from now on
    std::optional<double> cruise_s = {};                         ///< else: of the whole cruise; none: of the path
    std::optional<mechanical::FlightState> motion = {};          ///< of the remaining cruise; or
    std::shared_ptr<const path::PathForecast> path = {};         ///< its path
    std::optional<battery::Battery> battery = {};
    std::string battery_file = {};                   ///< for errors
    std::optional<double> initial_soc_percent = {};  ///< none: by the resting voltage
    battery::LandingLimits limits = {};
    std::string no_prediction_reason = {};  ///< why the model allows none; empty: it does
};

struct BatteryPrediction {
    battery::LandingForecast expected;
    battery::LandingForecast worst;  ///< at the high end of energy, and the low end of capacity if known
    battery::LandingLimits limits;   ///< of the mission
    bool worst_uses_min_capacity = false;
    double initial_soc_percent = 0.0;
    bool initial_is_measured = false;     ///< by the resting voltage
    bool initial_soc_is_current = false;  ///< earlier charge is unknown: `initial_soc_percent` is the current value
};

struct Prediction {
    mechanical::FlightProgress flown;
    bool began_in_air = false;              ///< the lift-off was not received: `flown` counts from the first message
    std::optional<double> on_path_s = {};   ///< position on the path, as its planned time
    bool is_from_position = false;          ///< of `on_path_s`: by the aircraft's positions, not by the time
    double takeoff_s = 0.0;                 ///< of the take-off, as expected; 0: in cruise
    mechanical::EnergyEstimate takeoff;     ///< of that time
    double remaining_s = 0.0;               ///< of the cruise
    std::optional<double> overtime_s = {};  ///< of the cruise beyond the mission's: then the landing begins now
    bool uses_physical_model = false;       ///< for the cruise; else the curve
    mechanical::RemainingCruise cruise;
    std::vector<battery::ConstantLoad> remaining_power = {};  ///< planned, along the path; empty: constant
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    double landing_sd_s = 0.0;  ///< of `landing_s`; 0: it is stated
    mechanical::EnergyEstimate remaining_energy;
    mechanical::EnergyInterval interval;
    std::optional<BatteryPrediction> battery = {};
};

/// Messages to the user about a prediction.
struct Remarks {
    std::vector<std::string> warnings;
    std::vector<std::string> notes;
};

/// Throws InputError for a model without between-flight variability of a phase, which an interval requires.
void require_interval(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file);

/// Throws InputError for a model without a physical part or its between-flight variability, which `option` requires.
void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option);

/// The state of charge at the start of a record: the given one, else by its resting voltage. The input has a battery.
/// Throws InputError where neither is available (a battery of constant voltage).
double initial_soc_percent(const PredictionInput& input, const battery::DischargeRecord& flown);

/// By the resting voltage only.
double initial_soc_by_voltage_percent(const PredictionInput& input, const battery::DischargeRecord& flown);

/// Predicts the remaining flight from its progress and its series until now; of a cruise beyond the mission's, a
/// landing from now. Throws NoResultError where more charge was drawn than available, or an energy below 0 is predicted, UsageError for a remaining time
/// longer than the path, and as mechanical::predict_remaining_flight and battery::discharge_records.
Prediction predict_flight(const PredictionInput& input, const mechanical::FlightProgress& flown,
                          const flight::FlightData& data, Remarks& remarks);

/// As predict_flight, without the battery. `fix`: position on the path; none: by the time since the cruise began.
Prediction predict_energy(const PredictionInput& input, const mechanical::FlightProgress& flown,
                          const std::optional<path::PathFix>& fix, Remarks& remarks);

/// Expected loads of the remaining take-off, the remaining cruise and the landing, times `factor`.
std::vector<battery::ConstantLoad> remaining_power(const Prediction& prediction, double factor = 1.0);

double energy_j(const std::vector<battery::ConstantLoad>& loads);

/// The high end of the remaining energy's interval by its expectation.
double high_energy_factor(const Prediction& prediction);

/// Forecasts the battery to the landing. `state_of`: the current state of a battery of that capacity.
BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const std::function<battery::BatteryState(const battery::Battery&)>& state_of,
                                   const Prediction& prediction);

struct ReturnDeadline {
    std::optional<double> latest_in_s;  ///< none: the reserve cannot be kept any more
    bool path_can_be_flown = false;     ///< or the cruise, to its end, and home from there: `latest_in_s` is the end
};

/// The latest moment to leave the path and fly straight home, level, at the path's current airspeed and in the plan's
/// wind, or without a path to begin the landing, so that it keeps the reserve at the high end of the energy's interval.
/// A cruise beyond the mission's continues at its mean power. Evaluated every 10 s, or at 40 moments. The input has a
/// battery; `now`: its state.
ReturnDeadline latest_return(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now);

struct TimeCurve {
    std::vector<double> time_s;  ///< on the telemetry's clock
    std::vector<double> value;
};

/// Predicted state of charge from `now_s` to the landing, or until the battery fails, at up to about a hundred points.
/// The input has a battery.
TimeCurve predict_soc_curve(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now,
                            double now_s);

/// From a mission with a mechanical model: model, path or cruise duration, battery (capacity as uncertain as in the
/// mission's drawn flights) and limits; `no_prediction_reason` where its model allows no prediction. `file`: of the
/// mission, for errors. Throws InputError for an infeasible path.
PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// As input_from_mission, without the battery. Throws InputError where the model allows no prediction.
PredictionInput energy_input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// `remaining_s` more of the cruise from any moment on, then the model's landing. Throws as require_interval.
PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s);

}  // namespace flightwatt::live
