#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <optional>

namespace flightwatt::flight {

/// Where the clock of a sender began anew, as early as the log shows it: a time that comes more than a minute late is
/// another recording; times that come more than 2 s late, ten of them, between neighbours that lack none (closer than
/// one and a half times the lower decile of up to a hundred intervals before), are a second stretch over the first.
/// Lines that are only out of order fill the holes that they left, and doubled lines are equal: neither counts.
std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender);

}  // namespace flightwatt::flight
