#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <filesystem>
#include <string>

namespace flightwatt::flight {

/// The phases CSV: sortie, phase, start_s, end_s, duration_s, samples, mean_power_w, energy_wh, ... and the
/// evidence at both edges; a witness that is absent leaves its cell empty, as a power that was not measured does.
std::string phases_csv(const FlightSeries& series, const FlightPhases& phases);

/// Reads what phases_csv wrote: the sorties with their phases and the evidence at the edges. Statistics are
/// not read (they are the series'), nor heights, which the file does not hold. Throws InputError for a column
/// missing, a phase that there is none of, a number that is none, and sorties that do not count up from 1.
FlightPhases read_phases_csv(const std::filesystem::path& path);

}  // namespace flightwatt::flight
