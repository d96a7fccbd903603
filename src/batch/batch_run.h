#pragma once

#include "base/text_table.h"
#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::batch {

class WriteGate;

struct BatchOptions {
    std::filesystem::path out;
    flight::LoadOptions load;
    unsigned jobs = 0;  ///< logs at a time; 0: one a core
    std::size_t needed_samples = 8;
    WriteGate* gate = nullptr;  ///< passed to write a file, if there is one
};

/// A sortie that a fit takes, and which of its phases.
struct SelectedSortie {
    std::string flight;  ///< see flight_name_of_sortie
    flight::PerPhase<bool> phases;
};

/// What a fit takes from a log. Its samples stay in the record until they are needed (read_samples).
struct Selection {
    std::vector<SelectedSortie> flights;  ///< none if the log was rejected
    std::vector<mechanical::Exclusion> exclusions;
};

/// One log of a batch, done or found up to date.
struct BatchFlight {
    FlightRecord record;
    bool was_up_to_date = false;
    bool is_of_this_run = true;  ///< see LogFile
    bool is_kept = false;        ///< its log is gone: it is as an earlier run left it
    Selection selection;
};

/// Called as logs finish, from one thread at a time: how many are done, of how many, and which it was.
using BatchProgress = std::function<void(std::size_t done, std::size_t all, const BatchFlight& flight)>;

/// Parses and segments every log, several at a time, into OUT/flights/NAME.series.csv, NAME.phases.csv and
/// NAME.record.json, the last one written last. A log whose record has the fingerprint of its content, its
/// .log and the options, and whose files are as they were written, is not done again; one that is gone keeps its
/// results. Logs that cannot be used, whatever is wrong with them, are recorded as rejected; the rest goes on. Returned
/// in the order of `logs`. Throws OutputError where OUT cannot be written. The folder is to be prepared before
/// (manifest.h).
std::vector<BatchFlight> run_batch(const std::vector<LogFile>& logs, const BatchOptions& options,
                                   const BatchProgress& progress);

/// Every flight that is selected, with its samples. Throws InputError where a record is no longer as it was.
std::vector<mechanical::MeasuredFlight> read_samples(const std::vector<BatchFlight>& flights,
                                                     const BatchOptions& options);

/// What select_for_fit selected, without its samples.
Selection selection_of(mechanical::MeasuredFlights measured);

/// Flights that are there more than once.
struct RepeatedFlights {
    std::map<std::string, std::string> same_as;                   ///< which is another under a second name, and which
    std::vector<std::pair<std::string, std::string>> overlaps{};  ///< flight and warning: it shares less than half
};

/// Each flight is used once: one with power, of these one whose log is still there, of these the better copy
/// (is_better_copy), then the first. Reads the marks of their contents from the records in OUT.
RepeatedFlights find_repeated(const std::vector<BatchFlight>& flights, const std::filesystem::path& out);

/// Takes copies out of what is fitted, and says so; warns of overlaps. Returns which flight with power is a copy of which,
/// by name.
std::map<std::string, std::string> exclude_repeated(std::vector<BatchFlight>& flights, const RepeatedFlights& repeated);

/// Why a flight is not fitted that is a copy of another.
std::string reason_of_copy(const std::string& other);

/// Why the flights that are fitted are not of one aircraft (describe_mix); empty if they may be.
std::string mix_of(const std::vector<BatchFlight>& flights);

/// A row a sortie (or rejected log) for people.
TextTable flights_table(const std::vector<BatchFlight>& flights);

/// OUT/flights.csv: flight,sortie,phase,start_s,end_s,duration_s,samples,mean_power_w,energy_wh,
/// counter_energy_wh,used and more; rejected logs have a row with their error.
std::string catalogue_csv(const std::vector<BatchFlight>& flights);

}  // namespace flightwatt::batch
