#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The messages and fields that a FlightSeries is made of.
std::vector<telemetry::MessageRequest> flight_messages();

/// The ids of the aircraft that flew in the log: the segmentation finds a sortie in their altitude and
/// throttle. If none flew, those that sent such messages.
std::vector<std::string> flown_aircraft(const telemetry::TelemetryLog& log);

/// The channels of one aircraft on the clock of its power samples. Throws InputError where it measured no
/// power, naming what was looked at and what the log holds.
FlightSeries flight_series(const telemetry::TelemetryLog& log, const std::string& aircraft_id);

}  // namespace flightwatt::flight
