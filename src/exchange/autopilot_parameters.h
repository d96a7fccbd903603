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

}  // namespace flightwatt::exchange
