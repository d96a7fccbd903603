#pragma once

#include "base/atomic_file.h"
#include "base/text_table.h"
#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::batch {

/// A sortie that a fit takes, and which of its phases.
struct SelectedSortie {
    std::string flight;  ///< see sortie_name
    flight::PerPhase<bool> phases;
};

/// What a fit takes from a log. Its samples stay in the record until they are needed (read_samples).
struct Selection {
    std::vector<SelectedSortie> flights;  ///< none if the log was rejected
    std::vector<mechanical::Exclusion> exclusions;
};

/// One log of a batch, done or found up to date. Of its record without what its file alone holds: samples,
/// verdicts, path and origin of the current. A hundred thousand take 150 to 180 MB.
struct BatchFlight {
    FlightRecord record;
    bool was_up_to_date = false;
    bool is_of_this_run = true;   ///< see LogFile
    bool log_is_missing = false;  ///< its log is gone: it is as an earlier run left it
    Selection selection;
};

/// In the order of the batch's logs.
using BatchFlights = std::vector<BatchFlight>;

struct BatchOptions {
    std::filesystem::path out;
    flight::LoadOptions load;
    unsigned jobs = 0;  ///< logs at a time; 0: one a core
    std::size_t min_samples = 8;
};

/// Called as logs finish, from one thread at a time: how many are done, of how many, and which it was.
using BatchProgress = std::function<void(std::size_t done, std::size_t all, const BatchFlight& flight)>;

/// Parses and segments every log, several at a time, into OUT/flights/NAME.series.csv, NAME.phases.csv and
/// NAME.record.json, the last one written last. A log whose record has the fingerprint of its content, its
/// .log and the options, and whose files are as they were written, is not done again; one that is gone keeps its
/// results. Logs that cannot be used, whatever is wrong with them, are recorded as rejected; the rest goes on. Returned
/// in the order of `logs`. Throws OutputError where OUT cannot be written. The folder is to be prepared before
/// (manifest.h).
BatchFlights run_batch(const std::vector<LogFile>& logs, const BatchOptions& options, const BatchProgress& progress);

/// Every flight that is selected, with its samples. Throws InputError where a record is no longer as it was.
std::vector<mechanical::MeasuredFlight> read_samples(const BatchFlights& flights, const BatchOptions& options);

/// A log that is done: what select_for_fit selects of its record, without the samples.
BatchFlight without_samples(FlightRecord record, std::size_t min_samples, const flight::LoadOptions& options);

/// A flight that is another one under a second name.
struct DuplicateFlight {
    std::string flight;
    std::string same_as;    ///< the one that is used
    bool has_power = true;  ///< or nothing of it would be fitted anyway
    bool operator==(const DuplicateFlight&) const = default;
};

/// Flights that are there more than once, by name. Each flight is used once: one with power, of these one whose log is
/// still there, of these one with its definitions, then the first.
std::vector<DuplicateFlight> find_duplicates(const BatchFlights& flights);

/// What is used instead of a flight with power; nullptr if it is itself.
const std::string* original_of(const std::string& flight, const std::vector<DuplicateFlight>& copies);

/// Takes copies out of what is fitted, and says so.
void exclude_duplicates(BatchFlights& flights, const std::vector<DuplicateFlight>& copies);

/// Why a flight is not fitted that is a copy of another.
std::string duplicate_reason(const std::string& other);

/// Drops what the table, the catalogue and the notes alone need: phases, warnings and exclusions. Of many logs that is
/// half of their memory, which the fit needs.
void release_details(BatchFlights& flights);

/// Why the flights that are fitted are not of one aircraft (describe_mixed_aircraft); empty if they may be.
std::string mixed_aircraft_reason(const BatchFlights& flights);

/// What became of the logs, in all.
struct Totals {
    std::size_t accepted = 0;
    std::size_t with_power = 0;  ///< accepted ones; without any there is nothing to fit
    std::size_t of_this_run = 0;
    std::size_t rejected_of_this_run = 0;
};

Totals totals_of(const BatchFlights& flights);

/// A row a sortie (or rejected log) for people, of the first logs.
TextTable flights_table(const BatchFlights& flights, std::size_t max_logs);

/// OUT/flights.csv, piece by piece, as long as `flights` is there:
/// flight,sortie,phase,start_s,end_s,duration_s,samples,mean_power_w,energy_wh, counter_energy_wh,used and more;
/// rejected logs have a row with their error.
TextWriter catalogue_csv(const BatchFlights& flights);

}  // namespace flightwatt::batch
