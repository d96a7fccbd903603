#include "batch/batch_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "batch/batch_files.h"
#include "batch/write_guard.h"
#include "flight/load_flight.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

std::filesystem::path flights_folder(const BatchOptions& options) { return options.out / "flights"; }

std::filesystem::path result_path(const BatchOptions& options, const std::string& flight, const char* ending) {
    return flights_folder(options) / (flight + ending);
}

void write_result(const BatchOptions& options, const std::string& flight, const char* ending,
                  const std::string& content) {
    std::optional<WriteGate::Pass> pass;
    if (options.gate != nullptr) pass.emplace(*options.gate);
    write_file_atomically(result_path(options, flight, ending), content);
}

/// Of everything that the result depends on.
std::string fingerprint_of(const flight::FlightFile& file, const LogFile& log, const BatchOptions& options) {
    const auto& load = options.load;
    const auto& segmentation = load.segmentation;
    Fingerprint fingerprint;
    fingerprint.add(FLIGHTWATT_VERSION " record 7");
    fingerprint.add(log.flight);
    fingerprint.add(log.path.string());
    fingerprint.add(load.aircraft_id.value_or(""));
    fingerprint.add(log.why_not_fitted);
    fingerprint.add(load.correct_idle_offset ? "idle offset corrected" : "");
    fingerprint.add(load.sortie ? fmt::format("sortie {}", *load.sortie) : "");
    fingerprint.add(fmt::format("{} {} {} {} {} {}", segmentation.rest_s, segmentation.hold_s,
                                segmentation.idle_throttle_percent, segmentation.cruise_fraction,
                                segmentation.ground_fraction, segmentation.flight_height_m));
    fingerprint.add(file.text());
    fingerprint.add(file.log_text().value_or("no .log"));
    return fingerprint.hex();
}

/// Of the files that an accepted log left; empty if one is missing.
std::string results_fingerprint(const BatchOptions& options, const std::string& flight) {
    Fingerprint fingerprint;
    for (const auto* ending : {series_ending, phases_ending}) {
        const auto path = result_path(options, flight, ending);
        if (!std::filesystem::is_regular_file(path)) return "";
        fingerprint.add(read_file(path));
    }
    return fingerprint.hex();
}

bool has_results(const BatchOptions& options, const std::string& flight) {
    return std::filesystem::exists(result_path(options, flight, series_ending)) ||
           std::filesystem::exists(result_path(options, flight, phases_ending));
}

/// The remembered result of a log, if it is that of this fingerprint and its files are as they were written.
std::optional<FlightRecord> remembered(const BatchOptions& options, const LogFile& log,
                                       const std::string& fingerprint) {
    const auto path = result_path(options, log.flight, record_ending);
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    auto record = record_from_json(read_file(path));
    if (!record || record->fingerprint != fingerprint) return std::nullopt;
    const bool as_written =
        record->accepted ? !record->results.empty() && record->results == results_fingerprint(options, log.flight)
                         : !has_results(options, log.flight);
    if (!as_written) return std::nullopt;
    record->flight = log.flight;  // JSON holds no name that is not UTF-8
    return record;
}

void remove_results(const BatchOptions& options, const std::string& flight) {
    std::error_code ignored;
    for (const auto* ending : {record_ending, series_ending, phases_ending}) {
        std::filesystem::remove(result_path(options, flight, ending), ignored);
    }
}

std::string describe(const InputError& error) {
    return fmt::format("{}: {}{}{}", to_string(error.where()), error.what(), error.hint().empty() ? "" : "; ",
                       error.hint());
}

/// Reads, segments and writes one log. Throws InputError where it cannot be used.
FlightRecord do_accepted(const flight::FlightFile& file, const LogFile& log, const BatchOptions& options) {
    auto load = options.load;
    load.power_required = false;
    auto loaded = flight::load_flight(file, load);
    loaded.series.flight = log.flight;
    auto record = record_of(loaded);
    record.why_not_fitted = log.why_not_fitted;
    write_result(options, log.flight, series_ending, to_csv(loaded.series));
    write_result(options, log.flight, phases_ending, flight::phases_csv(loaded.series, loaded.phases));
    return record;
}

BatchFlight do_log(const LogFile& log, const BatchOptions& options) {
    BatchFlight done;
    std::string fingerprint;
    try {
        const flight::FlightFile file(log.path, options.load.most_log_bytes);
        fingerprint = fingerprint_of(file, log, options);
        file.require_unchanged();
        if (auto record = remembered(options, log, fingerprint)) {
            done.was_up_to_date = true;
            done.record = std::move(*record);
            done.selection = select_for_fit(done.record, options.needed_samples, options.load);
            return done;
        }
        remove_results(options, log.flight);
        done.record = do_accepted(file, log, options);
    } catch (const InputError& error) {
        remove_results(options, log.flight);
        done = {};
        done.record.error = describe(error);
    }
    done.record.flight = log.flight;
    done.record.log = log.path.string();
    done.record.fingerprint = fingerprint;
    if (done.record.accepted) done.record.results = results_fingerprint(options, log.flight);
    const auto text = to_json_text(done.record);
    write_result(options, log.flight, record_ending, text);
    done.record = record_from_json(text).value();  // what later runs remember: both must report the same
    done.record.flight = log.flight;
    done.selection = select_for_fit(done.record, options.needed_samples, options.load);
    return done;
}

}  // namespace

std::vector<BatchFlight> run_batch(const std::vector<LogFile>& logs, const BatchOptions& options,
                                   const BatchProgress& progress) {
    make_directories(flights_folder(options));
    remove_left_overs(logs, options.out);
    std::vector<BatchFlight> flights(logs.size());
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // guards what follows
    std::size_t done = 0;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t i = next++; i < logs.size(); i = next++) {
            try {
                flights[i] = do_log(logs[i], options);
                const std::lock_guard lock(mutex);
                progress(++done, logs.size(), flights[i]);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                next = logs.size();
            }
        }
    };
    const auto cores = std::max(1u, std::thread::hardware_concurrency());
    const auto jobs = std::min<std::size_t>(options.jobs > 0 ? options.jobs : cores, logs.size());
    {
        std::vector<std::jthread> workers;
        for (std::size_t i = 1; i < jobs; ++i) workers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
    return flights;
}

}  // namespace flightwatt::batch
