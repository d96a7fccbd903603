#pragma once

#include "telemetry/mavlink/frames.h"

#include <cstddef>
#include <map>

namespace flightwatt::telemetry {

/// Returns whether a heartbeat is of the autopilot of a vehicle, and not of a ground station, camera or computer.
bool is_autopilot(const MavlinkFrame& heartbeat);

/// The component that flies a system.
struct Autopilot {
    int component = 0;
    int rank = 0;  ///< of its claim: that of a named autopilot goes before that of component 1, and this before others
};

/// Adds the autopilot that sent a heartbeat to those of the systems, unless the one that is known has no lower rank.
void add_autopilot(const MavlinkFrame& heartbeat, std::map<int, Autopilot>& autopilots);

/// Returns whether a message is of the autopilot `component` of its system, or BATTERY_STATUS of a smart battery.
bool is_of_vehicle(const MavlinkFrame& frame, int component);

/// Returns the value of a field of a known message; the id of a second smart battery (component 181) that calls itself
/// the first, 0, is 1.
double value_of(const MavlinkFrame& frame, std::size_t field);

}  // namespace flightwatt::telemetry
