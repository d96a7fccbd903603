#pragma once

#include "batch/flight_record.h"

#include <filesystem>
#include <vector>

namespace flightwatt::batch {

/// A log as a batch left it in its folder.
struct StoredFlight {
    FlightRecord record;
    flight::FlightSeries series;  ///< of an accepted log
    flight::FlightPhases phases;  ///< with the evidence at their edges, which the record does not hold
};

/// What a batch wrote into OUT, flight by flight, by name. Throws InputError where OUT is no batch's folder,
/// a record is damaged, or an accepted flight's files are missing or not as the batch writes them.
std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out);

}  // namespace flightwatt::batch
