#pragma once

#include "battery/battery.h"
#include "battery/identification/aligned_fit.h"
#include "battery/identified_battery.h"

#include <optional>
#include <vector>

namespace flightwatt::battery {

/// What one flight tells of the state of its pack.
struct FlightHealth {
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< only where it was asked for, and the flight tells it
};

/// Of each record, in one least squares with the curve, the RC resistance, the rests and the initial charges: a series
/// resistance and, `with_capacity`, a factor on the charge drawn (the mean of their logarithms is 0). Errors by the
/// jackknife over a dozen blocks of each flight, not less than for independent samples; those of capacities also hold
/// 10 mV a cell over the voltage's fall. No resistance where current or charge varies too little, no capacity where its
/// interval is wider than 15 % to either side.
std::vector<FlightHealth> estimate_state_of_health(const JointCircuitFit& aligned, bool with_capacity);

}  // namespace flightwatt::battery
