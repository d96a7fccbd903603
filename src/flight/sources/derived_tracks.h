#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// The first of the commands to the actuators: a throttle where it is never negative.
inline constexpr auto commanded_throttle = "COMMANDS.throttle";

/// The last two fields of a 4-field ENERGY, read the other way round (energy_and_power_are_swapped).
inline constexpr auto energy_read_as_power = "ENERGY.energy read as power";
inline constexpr auto power_read_as_energy = "ENERGY.power read as energy";

/// A candidate of a track from raw values at the times of a table, which has rows.
Track make_candidate(const std::string& name, const std::string& source, const telemetry::MessageTable& table,
                     std::vector<double> values, Merge merge);

/// Adds the candidates that are made of several fields, or of a field's other reading: power as voltage times
/// current, speed, wind and position of their components, a track each of every motor (ESC) and circuit
/// (POWER_DEVICE), whose sum needs values between samples and is made when it is asked for. Without a .log
/// (`definitions_assumed`), also a 4-field ENERGY with its last two fields read the other way round.
void add_derived_tracks(std::vector<Track>& tracks, const telemetry::SenderLog& sender, bool definitions_assumed);

}  // namespace flightwatt::flight
