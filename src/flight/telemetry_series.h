#pragma once

#include "flight/flight_series.h"
#include "telemetry/autopilot_log.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

struct LogFamily;

/// Finds the first restart of a sender's clock: a row more than a minute before a row that precedes it in the file
/// (another recording), or ten rows more than 2 s before (an overlapping recording). The latter count only between
/// neighbours closer than 1.5 times the lower decile of up to a hundred intervals before: lines out of order fill the
/// holes that they left, and repeated lines are equal.
std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender);

/// Splits a log into its recordings (telemetry/recordings.h), each with its own clock; one that overlaps another stays
/// with it.
std::vector<telemetry::TelemetryLog> recordings_of(telemetry::TelemetryLog log);

/// Returns the messages and fields that a FlightSeries is made of.
std::vector<telemetry::MessageRequest> flight_messages();

/// Returns the senders of telemetry, in the order of the log: those that sent more than single events.
std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log);

/// Returns the series of one aircraft, unchecked (see require_power()); without tracks if it sent nothing.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

/// Returns the messages and fields of MAVLink that a FlightSeries is made of.
std::vector<telemetry::MessageRequest> mavlink_flight_messages();

/// Returns the series of a vehicle by its messages of MAVLink, as far as they state facts: an airspeed without a sensor is
/// an estimate and left out, and of two messages of one battery the one with more of it counts.
FlightSeries mavlink_series(telemetry::AutopilotLog log);

/// Returns the series of the aircraft of an autopilot's log.
FlightSeries family_series(telemetry::AutopilotLog log, const LogFamily& family);

}  // namespace flightwatt::flight
