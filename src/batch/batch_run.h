#pragma once

#include "base/text_table.h"
#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
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

/// One log of a batch, done or found up to date.
struct BatchFlight {
    FlightRecord record;
    bool was_up_to_date = false;
    mechanical::MeasuredFlights selection;  ///< what a fit takes from it; empty if it was rejected
};

/// Called as logs finish, from one thread at a time: how many are done, of how many, and which it was.
using BatchProgress = std::function<void(std::size_t done, std::size_t all, const BatchFlight& flight)>;

/// Parses and segments every log, several at a time, into OUT/flights/NAME.series.csv, NAME.phases.csv and
/// NAME.record.json, the last one written last. A log whose record has the fingerprint of its content, its
/// .log and the options, and whose files are as they were written, is not done again. Logs that cannot be
/// used are recorded as rejected; the rest goes on. Results of logs that are no longer among `logs` are
/// removed. Returned in the order of `logs`. Throws OutputError where OUT cannot be written.
std::vector<BatchFlight> run_batch(const std::vector<LogFile>& logs, const BatchOptions& options,
                                   const BatchProgress& progress);

/// A row a sortie (or rejected log) for people.
TextTable flights_table(const std::vector<BatchFlight>& flights);

/// OUT/flights.csv: flight,sortie,phase,start_s,end_s,duration_s,samples,mean_power_w,energy_wh,
/// counter_energy_wh,used and more; rejected logs have a row with their error.
std::string catalogue_csv(const std::vector<BatchFlight>& flights);

}  // namespace flightwatt::batch
