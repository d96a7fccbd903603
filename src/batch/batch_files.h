#pragma once

#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::batch {

/// Fingerprint of the files of an accepted log.
std::string results_fingerprint(std::string_view series_csv, std::string_view phases_csv);

/// The record of a flight whose files are unchanged. Throws InputError for others.
FlightRecord read_verified_record(const std::filesystem::path& out, const std::string& flight);

/// Records of one log by recording, the first one first.
using FlightRecords = std::vector<FlightRecord>;

/// The same of all recordings of a log.
FlightRecords read_verified_records(const std::filesystem::path& out, const std::string& flight);

/// A log in the folder of a batch.
struct StoredFlight {
    FlightRecord record;
    flight::FlightSeries series;     ///< of an accepted log
    flight::FlightPhases phases;     ///< with the evidence at their edges
    std::string damage_reason = {};  ///< why its files are not used, or empty
};

/// The flights in OUT by name. Throws InputError where OUT is not a batch's folder, or files of a flight are missing,
/// damaged or changed; if its log is missing too, the flight has a damage_reason instead.
/// Without `with_series` they have neither series nor phases, which are verified nevertheless.
std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out, bool with_series = true);

/// Locks a folder against other runs of batch or profile (flock; ignored by file systems without locks). Throws
/// OutputError if another run holds it, or the folder cannot be opened.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int folder_ = -1;
};

/// Removes a folder at the end if it is empty.
struct RemoveIfEmpty {
    std::filesystem::path folder;
    ~RemoveIfEmpty();
};

}  // namespace flightwatt::batch
