#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::flight {

/// A value that a log does not have: make_track() leaves it out.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// Source of the first command to the actuators: a throttle if it is never negative.
inline constexpr auto commanded_throttle = "COMMANDS.throttle";

/// Returns a candidate of the track `name` from raw values at the times of a table, which has rows.
Track make_candidate(const std::string& name, const std::string& source, const telemetry::MessageTable& table,
                     const std::vector<double>& values, Merge merge);

/// Returns the WGS 84 latitude and longitude [deg] of Paparazzi's UTM coordinates (east [m], north [m], zone), whose
/// north has no false origin and is negative in the south. NaN if one of them is NaN or the zone is not 1 to 60.
std::pair<double, double> position_from_utm(const std::vector<double>& east_north_zone);

/// Adds a track for every motor (ESC) and circuit (POWER_DEVICE), and the messages of take-offs.
void add_derived_tracks(std::vector<Track>& tracks, const telemetry::SenderLog& sender);

}  // namespace flightwatt::flight
