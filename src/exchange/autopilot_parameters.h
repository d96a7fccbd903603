#pragma once

#include "battery/battery.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <string>
#include <vector>

/// Input and result of the functions that write parameters for autopilots, ground stations and simulators. Each name,
/// unit and conversion: docs/exports.md.
namespace flightwatt::exchange {

/// An aircraft for an energy estimator or a simulator. A parameter whose value is absent here is not written.
struct EstimatorInput {
    std::optional<mechanical::MechanicalModel> model = {};
    std::optional<battery::Battery> battery = {};
    double compute_w = 0.0;                      ///< mean power of the computer, in addition to the model's
    std::optional<double> idle_w = {};           ///< power with the motor off; default: compute_w
    std::optional<double> reserve_percent = {};  ///< charge to keep at landing
    std::optional<int> cells_in_series = {};     ///< default: the battery's, else the minimum for 4.25 V a cell
    int cells_in_parallel = 1;
};

/// A text of parameters, and notes for the user.
struct ParameterText {
    std::string text;
    std::vector<std::string> notes = {};
};

}  // namespace flightwatt::exchange
