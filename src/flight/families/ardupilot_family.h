#pragma once

#include "flight/families/log_family.h"

#include <map>
#include <string>

namespace flightwatt::flight {

/// Returns the messages and fields of ArduPilot's DataFlash logs that have the quantities of a flight.
const LogFamily& ardupilot_family();

/// Returns the serial number of the board that the log's texts state: "00310019-3138510E-35363631"; empty without it.
std::string board_serial(const telemetry::LogFacts& facts);

/// Sets the kinds of battery monitors by BATT_MONITOR, BATT2_MONITOR ..., and that the current was computed from the
/// throttle where each of them computes it.
void add_monitor_kinds(const std::map<std::string, double>& parameters, FlightSeries& series);

/// Returns the serial numbers of the packs of smart batteries by parameters. Only their monitors set them: elsewhere the
/// parameter may be the number of a place (DroneCAN's battery_id), or of a pack that was changed since.
std::string pack_serials(const std::map<std::string, double>& parameters);

}  // namespace flightwatt::flight
