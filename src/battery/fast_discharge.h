#pragma once

#include "battery/discharge.h"

#include <cstdint>

namespace flightwatt::battery {

/// How long the steps of fast_discharge may be, and where the battery ends.
struct FastDischargeOptions {
    double max_s = 20.0;  ///< over which the load's power is nearly a parabola
    double cutoff_voltage_v = 0.0;
};

/// As discharge(), for flights that are flown by the thousand: a Thévenin circuit under a load that never charges. Over
/// each step the current is a parabola through its start, middle and end, with which the RC pair's voltage is exact;
/// what ends the battery is found on parabolas, too. Within 1e-3 points and 1 mV of discharge() where the power is
/// constant, or a step a twelfth of its fastest harmonic. Throws std::invalid_argument if the circuit is none of
/// Thévenin's, or as discharge().
Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& steps);

/// In how many steps it takes a load of such a length that allows steps of `max_s`: none is longer than the RC pair's
/// time constant.
std::uint64_t fast_steps(const TheveninCircuit& circuit, double length_s, double max_s);

}  // namespace flightwatt::battery
