#pragma once

#include "battery/discharge.h"

#include <cstdint>

namespace flightwatt::battery {

/// The longest step of fast_discharge, and where the battery ends.
struct FastDischargeOptions {
    double max_s = 20.0;  ///< over which the load's power is nearly a parabola
    double cutoff_voltage_v = 0.0;
};

/// As discharge(), for a Thévenin circuit under a load that never charges, some hundred times faster (CircuitRun);
/// steps in which the battery may end are discharge()'s. Within 1e-3 points and 1 mV of discharge() where the power is
/// constant, or a step a twelfth of its fastest harmonic. Throws std::invalid_argument if the circuit is not
/// Thévenin's, or as discharge().
Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& options);

/// The number of steps of fast_discharge for a load of that length: none is longer than `max_s` or the RC pair's time
/// constant.
std::uint64_t fast_steps(const TheveninCircuit& circuit, double length_s, double max_s);

}  // namespace flightwatt::battery
