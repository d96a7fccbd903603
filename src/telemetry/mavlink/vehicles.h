#pragma once

#include "telemetry/mavlink/frames.h"

namespace flightwatt::telemetry {

/// Returns whether a heartbeat is of the autopilot of a vehicle, and not of a ground station, camera or computer.
bool is_autopilot(const MavlinkFrame& heartbeat);

/// Returns whether a message is of the autopilot `component` of its system, or BATTERY_STATUS of a smart battery.
bool is_of_vehicle(const MavlinkFrame& frame, int component);

}  // namespace flightwatt::telemetry
