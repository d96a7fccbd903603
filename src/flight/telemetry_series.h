#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Where the clock of a sender began anew, as early as the log shows it: a time that comes more than a minute late is
/// another recording; times that come more than 2 s late, ten of them, between neighbours that lack none (closer than
/// one and a half times the lower decile of up to a hundred intervals before), are a second stretch over the first.
/// Lines that are only out of order fill the holes that they left, and doubled lines are equal: neither counts.
std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender);

/// The messages and fields that a FlightSeries is made of.
std::vector<telemetry::MessageRequest> flight_messages();

/// The senders of telemetry, in the order of the log: those that sent more than single events.
std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log);

/// What the log tells of one aircraft; of one that sent nothing, no tracks. Judges nothing: see require_power.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

/// The same without a copy: the columns that it can use are empty in the log afterwards.
FlightSeries extract_flight_series(telemetry::TelemetryLog& log, const std::string& aircraft_id);

}  // namespace flightwatt::flight
