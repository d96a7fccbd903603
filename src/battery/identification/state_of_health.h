#pragma once

#include "battery/identification/aligned_fit.h"
#include "battery/identified_battery.h"

#include <optional>
#include <vector>

namespace flightwatt::battery {

/// What one flight shows of the state of its pack.
struct FlightHealth {
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< only where it was asked for, and the flight determines it
};

/// Of each record, from the joint fit with a series resistance of each and, `with_capacity`, a factor on the charge
/// drawn (the mean of their logarithms is 0). Errors of capacities also hold 10 mV a cell over the voltage's fall. No
/// resistance where current or charge varies too little, no capacity where its interval is wider than 15 % to either
/// side.
std::vector<FlightHealth> estimate_state_of_health(JointCircuitFit joint, bool with_capacity);

}  // namespace flightwatt::battery
