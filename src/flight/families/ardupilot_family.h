#pragma once

#include "flight/families/log_family.h"

namespace flightwatt::flight {

/// Returns the messages and fields of ArduPilot's DataFlash logs that have the quantities of a flight.
const LogFamily& ardupilot_family();

}  // namespace flightwatt::flight
