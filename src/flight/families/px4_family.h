#pragma once

#include "flight/families/log_family.h"

namespace flightwatt::flight {

/// Returns the topics and fields of PX4's ULog that have the quantities of a flight.
const LogFamily& px4_family();

/// Returns the messages and fields of sdlog2, PX4's log until 2017, that have the quantities of a flight.
const LogFamily& sdlog2_family();

}  // namespace flightwatt::flight
