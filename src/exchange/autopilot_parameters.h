#pragma once

#include "battery/battery.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <string>
#include <vector>

/// Parameters of the estimators of autopilots and ground stations. Each name, unit and conversion: docs/exports.md.
namespace flightwatt::exchange {

/// What an estimator is told of an aircraft. What is absent is left as it is on the autopilot.
struct EstimatorInput {
    std::optional<mechanical::MechanicalModel> model = {};
    std::optional<battery::Battery> battery = {};
    double compute_w = 0.0;                      ///< mean power of the computer, on top of the model's
    std::optional<double> idle_w = {};           ///< while the motor stands; default: the computer's
    std::optional<double> reserve_percent = {};  ///< of charge that should be left
    std::optional<int> cells_in_series = {};     ///< default: the battery's, else as few as 4.25 V a cell allow
    int cells_in_parallel = 1;
};

/// A text of parameters with what its reader should know, a line each.
struct ParameterText {
    std::string text;
    std::vector<std::string> notes = {};
};

/// PX4's BAT1_... and BAT_AVRG_CURRENT, as QGroundControl loads them. Needs the battery; the current also a model.
/// Throws InputError where it is absent, or a value is beyond what PX4 takes.
ParameterText to_px4(const EstimatorInput& input);

/// INAV's settings, as its CLI takes them: of the battery, the power of cruise and idling, the speed of cruise. Throws
/// InputError without battery and model, and where a value is beyond what INAV takes.
ParameterText to_inav(const EstimatorInput& input);

/// The constants of Paparazzi's energy monitor (sw/ground_segment/python/energy_mon), as Python: power over airspeed in
/// level flight, energies of take-off and landing, the pack. Throws InputError without battery and physical model.
ParameterText to_paparazzi(const EstimatorInput& input);

/// Its batterymodel.csv: cell voltage from 4.20 to 2.50 V by 0.01 V, and the charge drawn of a cell [mAh] where it
/// shows that voltage under 2, 4, 6, 8 and 10 A. Throws InputError without a battery, or for one of constant voltage.
ParameterText to_paparazzi_map(const EstimatorInput& input);

}  // namespace flightwatt::exchange
