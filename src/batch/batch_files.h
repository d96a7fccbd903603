#pragma once

#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::batch {

/// Of the files that an accepted log leaves.
std::string results_fingerprint(std::string_view series_csv, std::string_view phases_csv);

/// The record of a flight whose files are all as the batch wrote them. Throws InputError for others.
FlightRecord read_verified_record(const std::filesystem::path& out, const std::string& flight);

/// A log as a batch left it in its folder.
struct StoredFlight {
    FlightRecord record;
    flight::FlightSeries series;     ///< of an accepted log
    flight::FlightPhases phases;     ///< with the evidence at their edges, which the record does not hold
    std::string damage_reason = {};  ///< why its files are not used: they are not as the batch wrote them
};

/// What a batch wrote into OUT, flight by flight, by name. Throws InputError where OUT is no batch's folder, or the
/// files of a flight are missing, damaged or changed; where its log is gone too, so that no batch could mend that, the
/// flight is given as damaged instead.
std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out);

/// The same without series and phases, which are compared with their fingerprints all the same.
std::vector<StoredFlight> read_stored_records(const std::filesystem::path& out);

}  // namespace flightwatt::batch
