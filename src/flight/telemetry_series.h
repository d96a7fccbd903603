#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// The first restart of a sender's clock: a row of a message more than 20 s before a row that precedes it in the file.
std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender);

/// The messages and fields of a FlightSeries.
std::vector<telemetry::MessageRequest> flight_messages();

/// The senders of telemetry, in the order of the log: those that sent more than single events.
std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log);

/// The series of one aircraft; without tracks if it sent nothing. Checks nothing: see require_power.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

}  // namespace flightwatt::flight
