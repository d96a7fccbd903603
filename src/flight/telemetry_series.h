#pragma once

#include "flight/flight_series.h"
#include "telemetry/autopilot_log.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

struct LogFamily;

/// The first restart of a sender's clock: a row more than a minute before a row that precedes it in the file (another
/// recording), or ten rows more than 2 s before (an overlapping recording). The latter count only between neighbours
/// closer than 1.5 times the lower decile of up to a hundred intervals before: lines out of order fill the holes that
/// they left, and repeated lines are equal.
std::optional<ClockRestart> find_clock_restart(const telemetry::SenderLog& sender);

/// Rows of a clock that was set back by seconds and runs over the same times again: fewer than make a restart.
std::optional<telemetry::SkippedLines> find_clock_step(const telemetry::SenderLog& sender);

/// The recordings of a log (telemetry/recordings.h), each with its own clock; one that overlaps another stays with it.
std::vector<telemetry::TelemetryLog> recordings_of(telemetry::TelemetryLog log);

/// The messages and fields of a FlightSeries.
std::vector<telemetry::MessageRequest> flight_messages();

/// The senders of telemetry, in the order of the log: those that sent more than single events.
std::vector<std::string> telemetry_senders(const telemetry::TelemetryLog& log);

/// The series of one aircraft; without tracks if it sent nothing. Checks nothing: see require_power.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

/// The series of an autopilot's log, of one aircraft.
FlightSeries family_series(telemetry::AutopilotLog log, const LogFamily& family);

}  // namespace flightwatt::flight
