#pragma once

#include "flight/segmentation.h"

#include <filesystem>

namespace flightwatt::flight {

/// Reads what phases_csv wrote: the sorties with their phases and the evidence at the edges. Statistics are
/// not read (they are the series'), nor heights, which the file does not hold. Throws InputError for a column
/// missing, a phase that there is none of, a number that is none, and sorties that do not count up from 1.
FlightPhases read_phases_csv(const std::filesystem::path& path);

}  // namespace flightwatt::flight
