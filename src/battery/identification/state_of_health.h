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
/// resistance of its own and, `with_capacity`, a factor of its own on the charge that it draws (the mean of their
/// logarithms is 0). All are free together: with the curve of a common resistance held, flights on aged packs would
/// seem less aged than they are, as that curve has bent to them. Errors by the jackknife over a dozen blocks of each
/// flight's time, and not less than if samples were independent; those of capacities also hold 10 mV a cell that no
/// curve follows, over what the flight's voltage falls by. No resistance where current or charge varies too little, no
/// capacity where its interval is wider than 15 % to either side: the flight draws too little.
std::vector<FlightHealth> estimate_state_of_health(const JointCircuitFit& aligned, bool with_capacity);

}  // namespace flightwatt::battery
