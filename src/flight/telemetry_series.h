#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The messages and fields that a FlightSeries is made of.
std::vector<telemetry::MessageRequest> flight_messages();

/// The senders of telemetry, in the order of the log: those that sent more than single events.
std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log);

/// What the log tells of one aircraft; of one that sent nothing, no tracks. Judges nothing: see require_power.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

/// The same without a copy: the columns that it can use are empty in the log afterwards.
FlightSeries extract_flight_series(telemetry::TelemetryLog& log, const std::string& aircraft_id);

}  // namespace flightwatt::flight
