#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <filesystem>
#include <string>

namespace flightwatt::flight {

/// Returns the phases as CSV: sortie, phase, start_s, end_s, duration_s, samples, mean_power_w, energy_wh, ... and the
/// evidence at both edges; unknown values are empty cells.
std::string phases_csv(const FlightData& data, const FlightPhases& phases);

/// Reads a phases CSV: the sorties with their phases and the evidence at the edges, without statistics and heights.
/// Throws InputError for a missing column, an unknown phase, an invalid number, and sorties that do not count up from
/// 1.
FlightPhases read_phases_csv(const std::filesystem::path& path);

}  // namespace flightwatt::flight
