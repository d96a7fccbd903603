#pragma once

#include "flight/families/log_family.h"

namespace flightwatt::flight {

/// Returns the messages and fields of MAVLink that have the quantities of a flight.
const LogFamily& mavlink_family();

/// Returns the log without what repeats or guesses: SYS_STATUS's battery where BATTERY_STATUS has its voltage and current,
/// these where they have ended or are rare and SYS_STATUS has them, BATTERY2 where BATTERY_STATUS has the second one, and
/// VFR_HUD's airspeed if the autopilot has no enabled airspeed sensor, as it then states an estimate. Completes the
/// voltage of packs with more cells than BATTERY_STATUS holds.
telemetry::AutopilotLog without_doubtful_messages(telemetry::AutopilotLog log);

}  // namespace flightwatt::flight
