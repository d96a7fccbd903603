#pragma once

#include "flight/families/log_family.h"

namespace flightwatt::flight {

/// Returns where PX4's ULog has the quantities of a flight.
const LogFamily& px4_family();

/// Returns where sdlog2, the log of PX4 until 2017, has them.
const LogFamily& sdlog2_family();

}  // namespace flightwatt::flight
