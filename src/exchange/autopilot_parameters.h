#pragma once

#include "battery/battery.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <string>
#include <vector>

/// Parameters of the estimators of autopilots and ground stations, and of simulators. Each name, unit and conversion:
/// docs/exports.md.
namespace flightwatt::exchange {

/// An aircraft for an estimator or a simulator. Absent values are not set there.
struct EstimatorInput {
    std::optional<mechanical::MechanicalModel> model = {};
    std::optional<battery::Battery> battery = {};
    double compute_w = 0.0;                      ///< mean power of the computer, in addition to the model's
    std::optional<double> idle_w = {};           ///< with the motor off; default: the computer's
    std::optional<double> reserve_percent = {};  ///< of charge at landing
    std::optional<int> cells_in_series = {};     ///< default: the battery's, else the minimum for 4.25 V a cell
    int cells_in_parallel = 1;
};

/// A text of parameters, and notes for the user.
struct ParameterText {
    std::string text;
    std::vector<std::string> notes = {};
};

/// PX4's BAT1_... and BAT_AVRG_CURRENT, as QGroundControl loads them. Needs a battery, and a model
/// for the current. Throws InputError without a battery, and for values outside PX4's ranges.
ParameterText to_px4(const EstimatorInput& input);

/// INAV's settings for its CLI: battery, power in cruise and idle, cruise speed. Throws InputError without battery and
/// model, and for values outside INAV's ranges.
ParameterText to_inav(const EstimatorInput& input);

/// The constants of Paparazzi's energy monitor (sw/ground_segment/python/energy_mon), as Python: power over airspeed in
/// level flight, energies of take-off and landing, the pack. Throws InputError without battery and physical model.
ParameterText to_paparazzi(const EstimatorInput& input);

/// Its batterymodel.csv: cell voltage from 4.20 to 2.50 V by 0.01 V, and the charge drawn from a cell [mAh] at that
/// voltage under 2, 4, 6, 8 and 10 A. Throws InputError without a battery, or for one of constant voltage.
ParameterText to_paparazzi_map(const EstimatorInput& input);

/// SIM_BATT_... and BATT_CAPACITY of ArduPilot's SITL, a line "NAME VALUE" each. What a simulator does not represent is
/// in comments and notes, here and below. Throws InputError without a battery.
ParameterText to_ardupilot_sitl(const EstimatorInput& input);

/// SIM_BAT_... and the voltages of PX4's SITL, as QGroundControl loads them. Throws InputError without battery and
/// model and beyond PX4's ranges, NoResultError if a full battery cannot deliver the cruise.
ParameterText to_px4_sitl(const EstimatorInput& input);

/// SDF's <plugin> of Gazebo's LinearBatteryPlugin, for a <model>. Throws InputError without battery and model.
ParameterText to_gazebo(const EstimatorInput& input);

}  // namespace flightwatt::exchange
