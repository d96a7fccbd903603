#pragma once

#include "flight/flight_series.h"

#include <filesystem>
#include <optional>
#include <string>

namespace flightwatt::flight {

/// Reads a flight from a Paparazzi .data file (compressed or not, with its .log beside it) or a series CSV.
/// `aircraft_id` chooses one of several aircraft. Throws InputError where the file cannot be used, where
/// several aircraft flew and none is named (it says which), or where the named one sent nothing.
FlightSeries read_flight(const std::filesystem::path& path,
                         const std::optional<std::string>& aircraft_id = std::nullopt);

}  // namespace flightwatt::flight
