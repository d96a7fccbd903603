#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The first command to the actuators: a throttle if it is never negative.
inline constexpr auto commanded_throttle = "COMMANDS.throttle";

/// A candidate of a track from raw values at the times of a table, which has rows.
Track make_candidate(const std::string& name, const std::string& source, const telemetry::MessageTable& table,
                     const std::vector<double>& values, Merge merge);

/// Adds the candidates that are computed from several fields: power as voltage times current, speed, wind and position
/// from their components, and a track for every motor (ESC) and circuit (POWER_DEVICE).
void add_derived_tracks(std::vector<Track>& tracks, const telemetry::SenderLog& sender);

}  // namespace flightwatt::flight
