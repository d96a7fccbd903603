#pragma once

#include "flight/families/log_family.h"

namespace flightwatt::flight {

/// Returns where ArduPilot's DataFlash logs have the quantities of a flight.
const LogFamily& ardupilot_family();

}  // namespace flightwatt::flight
