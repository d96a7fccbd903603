#pragma once

#include "base/atomic_file.h"
#include "base/text_table.h"
#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::batch {

/// A sortie for a fit, and its phases.
struct SelectedSortie {
    std::string flight;  ///< see sortie_name
    flight::PerPhase<bool> phases;
    bool only_hovers = false;  ///< see MeasuredFlight
};

/// Sorties of a log for a fit; their samples stay in the record (read_samples).
struct Selection {
    std::vector<SelectedSortie> flights;  ///< none if the log was rejected
    std::vector<mechanical::Exclusion> exclusions;
};

/// One log of a batch, without the parts of its record that only the file holds: samples, edge checks, path and origin
/// of the current. 100,000 logs need 150 to 180 MB.
struct BatchFlight {
    FlightRecord record;
    bool was_up_to_date = false;
    bool is_of_this_run = true;         ///< see LogFile
    bool log_is_missing = false;        ///< the result is of an earlier run
    bool is_of_other_aircraft = false;  ///< than the one that is fitted
    Selection selection;
};

/// In the order of the batch's logs, and of the recordings of each.
using BatchFlights = std::vector<BatchFlight>;

struct BatchOptions {
    std::filesystem::path out;
    flight::LoadOptions load;
    unsigned jobs = 0;  ///< logs at a time; 0: one a core
};

/// The flights of all logs from those of each.
BatchFlights joined(std::vector<BatchFlights> of_logs);

/// Called for each flight of a finished log, from one thread at a time; `done` and `all` are of logs.
using BatchProgress = std::function<void(std::size_t done, std::size_t all, const BatchFlight& flight)>;

/// Parses and segments every log, several at a time, into OUT/flights/NAME.series.csv, NAME.phases.csv and
/// NAME.record.json (last). Logs with an up-to-date record and unchanged files are skipped; missing logs keep their
/// results; unusable logs are recorded as rejected. In the order of `logs`, after prepare_folder. Throws OutputError.
BatchFlights run_batch(const std::vector<LogFile>& logs, const BatchOptions& options, const BatchProgress& progress);

/// The selected flights with their samples. Throws InputError for a record that has changed.
std::vector<mechanical::MeasuredFlight> read_samples(const BatchFlights& flights, const BatchOptions& options);

/// The result of a log: the selection of select_for_fit, without the samples.
BatchFlight without_samples(FlightRecord record, const flight::LoadOptions& options);

/// A duplicate of another flight.
struct DuplicateFlight {
    std::string flight;
    std::string same_as;    ///< the flight that is fitted
    bool has_power = true;  ///< false: it would not be fitted anyway
    bool operator==(const DuplicateFlight&) const = default;
};

/// Duplicates by name. Of several, the one with power is fitted, then one whose log exists, then one with definitions,
/// then the first.
std::vector<DuplicateFlight> find_duplicates(const BatchFlights& flights);

/// The flight that is fitted instead of a duplicate with power; nullptr if it is not a duplicate.
const std::string* original_of(const std::string& flight, const std::vector<DuplicateFlight>& copies);

/// Excludes duplicates from the fit, with their reason.
void exclude_duplicates(BatchFlights& flights, const std::vector<DuplicateFlight>& copies);

/// Excludes the sorties of a VTOL that only hover where others of the same aircraft are on the wing, but for flights in
/// `keep`. Returns them with the reason (mechanical::exclude_hover).
std::vector<mechanical::Exclusion> exclude_hover(BatchFlights& flights, const std::set<std::string>& keep);

/// Reason for excluding a duplicate.
std::string duplicate_reason(const std::string& other);

/// The flights for a fit, to group them.
std::vector<FlightAircraft> fitted_aircraft(const BatchFlights& flights);

/// Leaves one group of fitted_aircraft for the fit. Returns the flights of the others.
std::set<std::string> keep_aircraft(BatchFlights& flights, const AircraftGroup& group,
                                    std::span<const FlightAircraft> fitted);

/// Numbers of logs by result.
struct Totals {
    std::size_t accepted = 0;
    std::size_t with_power = 0;  ///< accepted ones with power
    std::size_t of_this_run = 0;
    std::size_t rejected_of_this_run = 0;
};

Totals totals_of(const BatchFlights& flights);

/// A row a sortie or rejected log, of the first logs, with short ids of aircraft.
TextTable flights_table(const BatchFlights& flights, std::size_t max_logs, const ShortIds& short_ids = {});

/// OUT/flights.csv in chunks, as long as `flights` exists: a row a phase, and one a rejected log
/// (docs/reference/batch.md).
TextWriter catalogue_csv(const BatchFlights& flights);
/// Its columns.
Json catalogue_schema();

}  // namespace flightwatt::batch
