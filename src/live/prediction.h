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

/// The energy from a moment in cruise to the end of the flight: what predict and watch say.
namespace flightwatt::live {

/// What a prediction rests on beside the flight.
struct PredictionInput {
    mechanical::MechanicalModel model;
    std::optional<mechanical::CruisePrior> level = {};  ///< none: the curve
    double landing_s = 0.0;
    std::optional<double> remaining_s = {};  ///< of the cruise, from the moment on, whatever was flown
    std::optional<double> cruise_s = {};     ///< else: what is left of so long; none: what is left of the path
    std::optional<mechanical::FlightState> motion = {};   ///< how the rest is flown
    std::shared_ptr<const path::PathForecast> path = {};  ///< or along what
    std::optional<battery::Battery> battery = {};
    std::string battery_file = {};                   ///< for errors
    std::optional<double> initial_soc_percent = {};  ///< none: by the voltage at rest
    battery::LandingLimits limits = {};
    std::string no_prediction_reason = {};  ///< why the model does not allow it; empty: it does
};

/// The battery's part of a prediction.
struct BatteryPrediction {
    battery::LandingForecast expected;
    battery::LandingForecast worst;        ///< of energy's high end, and where its interval is known capacity's low one
    battery::LandingLimits limits;         ///< of the mission
    bool worst_uses_min_capacity = false;  ///< `worst`
    double initial_soc_percent = 0.0;
    bool initial_is_measured = false;     ///< by the resting voltage
    bool initial_soc_is_current = false;  ///< what was drawn before is not known: `initial_soc_percent` is that of now
};

struct Prediction {
    mechanical::FlightProgress flown;
    bool began_in_air = false;             ///< `flown` since the first message: the lift-off was not seen
    std::optional<double> on_path_s = {};  ///< where on its path the flight is, in the path's planned time
    bool is_from_position = false;         ///< there, by its positions; else by the time
    double remaining_s = 0.0;
    bool uses_physical_model = false;  ///< the cruise, by airspeed and climb; else by the curve
    mechanical::RemainingCruise cruise;
    std::vector<battery::ConstantLoad> remaining_power = {};  ///< the cruise's course along a path; empty: even
    mechanical::EnergyEstimate landing;
    double landing_s = 0.0;
    mechanical::EnergyEstimate remaining_energy;
    mechanical::EnergyInterval interval;
    std::optional<BatteryPrediction> battery = {};
};

/// What a user should know of a prediction.
struct Diagnostics {
    std::vector<std::string> warnings;
    std::vector<std::string> notes;
};

/// Throws InputError for a model whose interval would rest on nothing.
void require_interval(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file);

/// Throws InputError for a model that does not know how power follows from airspeed and climb, or how flights differ in
/// it. `option` is what needs that.
void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option);

/// The state of charge when a record began: as given, else by its voltage at rest. Throws InputError where a battery of
/// constant voltage would have to tell it. The basis has a battery.
double initial_soc_percent(const PredictionInput& basis, const battery::DischargeRecord& flown);

/// The same by the voltage at rest, whatever was given.
double initial_soc_by_voltage_percent(const PredictionInput& basis, const battery::DischargeRecord& flown);

/// The rest of a flight that is where `flown` says, and of which `series` holds what was measured until then. Throws
/// NoResultError where the moment does not allow it (the path is behind it, more charge was drawn than there was),
/// UsageError for a remaining time that the path does not have, and as mechanical::predict_remaining_cruise and
/// battery::discharge_records.
Prediction predict_flight(const PredictionInput& basis, const mechanical::FlightProgress& flown,
                          const flight::FlightSeries& series, Diagnostics& remarks);

/// The same without the battery. `sighting`: where the path is to go on from; none: after as long as it has cruised.
Prediction predict_energy(const PredictionInput& basis, const mechanical::FlightProgress& flown,
                          const std::optional<path::PathFix>& sighting, Diagnostics& remarks);

/// Where the positions see the flight on the path that is to be flown on; none where there is no path, where the time
/// that is left is stated, or without positions.
std::optional<path::PathFix> find_path_fix(const PredictionInput& basis, const mechanical::FlightProgress& flown,
                                           const flight::FlightSeries& series);

/// The stretches of power ahead, cruise and landing, as expected times `part`.
std::vector<battery::ConstantLoad> remaining_power(const Prediction& prediction, double part = 1.0);

/// Flies the battery through the rest of `prediction`. `state_of`: the state that a battery of that capacity is in now.
BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const std::function<battery::BatteryState(const battery::Battery&)>& state_of,
                                   const Prediction& prediction);

/// What a mission lets predict: its model, its path or else the time of its cruise, its battery (its capacity as
/// uncertain as in the mission's drawn flights) and limits. Where its model does not allow a prediction,
/// `no_prediction_reason` says why. The setup has a mechanical model; `file` names the mission in errors. Throws
/// InputError for a path that cannot be flown.
PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// The same without the battery. Throws InputError where the model does not allow a prediction.
PredictionInput path_input_from_mission(const mission::MissionSetup& setup, const std::string& file);

/// `remaining_s` more of the cruise from any moment on, and the model's usual landing. Throws as require_spread.
PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s);

}  // namespace flightwatt::live
