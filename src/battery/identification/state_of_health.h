#pragma once

#include "battery/identification/aligned_fit.h"
#include "battery/identified_battery.h"

#include <optional>
#include <vector>

namespace flightwatt::battery {

/// State of health of a pack by one flight.
struct FlightHealth {
    std::optional<FlightResistance> resistance;
    std::optional<FlightCapacity> capacity;  ///< only where it was asked for, and the flight determines it
    double initial_charge_error_ah = 0.0;    ///< standard error with a resistance of its own
};

/// Of each record, from the joint fit with a series resistance of each and, `with_capacity`, a factor on the charge
/// drawn (the mean of their logarithms is 0). Errors of capacities include 10 mV a cell over the voltage's fall. No
/// resistance with a standard error above half of it, no capacity with an interval of more than 15 % to either side.
std::vector<FlightHealth> estimate_state_of_health(JointCircuitFit joint, bool with_capacity);

}  // namespace flightwatt::battery
