#pragma once

#include "exchange/autopilot_parameters.h"

namespace flightwatt::exchange {

/// The battery as estimators see it, that know one resistance: after the RC pair has settled.
struct PackSummary {
    battery::Battery battery;  ///< with the RC pair's resistance in series
    int cells = 1;             ///< in series
    double capacity_mah = 0.0;
    double energy_wh = 0.0;  ///< at the open-circuit voltage, from full to empty
};

/// Throws InputError without a battery.
PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader);

/// Throws InputError without a model.
const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader);

/// The model's mean power of a phase, and the computer's [W].
double mean_power_w(const EstimatorInput& input, flight::Phase phase);

}  // namespace flightwatt::exchange
