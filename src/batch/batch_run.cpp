#include "batch/batch_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/fingerprint.h"
#include "flight/flight_reader.h"
#include "flight/series_csv.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>

namespace flightwatt {
namespace {

constexpr auto series_ending = ".series.csv";
constexpr auto phases_ending = ".phases.csv";
constexpr auto record_ending = ".record.json";

std::filesystem::path flights_folder(const BatchOptions& options) { return options.out / "flights"; }

std::filesystem::path result_path(const BatchOptions& options, const std::string& flight,
                                  const char* ending) {
    return flights_folder(options) / (flight + ending);
}

/// Of everything that the result depends on.
std::string fingerprint_of(const LogFile& log, const BatchOptions& options) {
    Fingerprint fingerprint;
    fingerprint.add(FLIGHTWATT_VERSION " record 1");
    fingerprint.add(log.flight);
    fingerprint.add(log.path.string());
    fingerprint.add(options.aircraft_id.value_or(""));
    fingerprint.add(DataFile(log.path).text());
    const auto configuration = find_log_file(log.path);
    fingerprint.add(configuration ? read_file(*configuration) : "no .log");
    return fingerprint.hex();
}

/// The remembered result of a log, if it is that of this fingerprint and its files are there.
std::optional<FlightRecord> remembered(const BatchOptions& options, const LogFile& log,
                                       const std::string& fingerprint) {
    const auto path = result_path(options, log.flight, record_ending);
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    auto record = record_from_json(read_file(path));
    if (!record || record->fingerprint != fingerprint) return std::nullopt;
    for (const auto* ending : {series_ending, phases_ending}) {
        if (std::filesystem::is_regular_file(result_path(options, log.flight, ending)) != record->accepted) {
            return std::nullopt;
        }
    }
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
BatchFlight do_accepted(const LogFile& log, const BatchOptions& options) {
    BatchFlight done;
    auto series = read_flight(log.path, options.aircraft_id);
    series.flight = log.flight;
    const auto phases = segment(series);
    require_sortie(series, phases, log.path.string());
    done.record = record_of(series, phases);
    done.selection = select_samples(series, phases, options.needed_samples);
    write_file_atomically(result_path(options, log.flight, series_ending), to_csv(series));
    write_file_atomically(result_path(options, log.flight, phases_ending), phases_csv(series, phases));
    return done;
}

BatchFlight do_log(const LogFile& log, const BatchOptions& options) {
    BatchFlight done;
    std::string fingerprint;
    try {
        fingerprint = fingerprint_of(log, options);
        if (auto record = remembered(options, log, fingerprint)) {
            done.was_up_to_date = true;
            done.record = std::move(*record);
            if (!done.record.accepted) return done;
            auto series = read_series_csv(result_path(options, log.flight, series_ending));
            series.flight = log.flight;
            done.selection = select_samples(series, phases_of(done.record), options.needed_samples);
            return done;
        }
        remove_results(options, log.flight);
        done = do_accepted(log, options);
    } catch (const InputError& error) {
        remove_results(options, log.flight);
        done = {};
        done.record.error = describe(error);
    }
    done.record.flight = log.flight;
    done.record.log = log.path.string();
    done.record.fingerprint = fingerprint;
    write_file_atomically(result_path(options, log.flight, record_ending), to_json_text(done.record));
    return done;
}

/// Results that an earlier run left of logs that are gone now.
void remove_vanished(const std::vector<LogFile>& logs, const BatchOptions& options) {
    std::set<std::string> names;
    for (const auto& log : logs) names.insert(log.flight);
    for (const auto& entry : std::filesystem::directory_iterator(flights_folder(options))) {
        const auto file = entry.path().filename().string();
        if (!file.ends_with(record_ending)) continue;
        const auto flight = file.substr(0, file.size() - std::string_view(record_ending).size());
        if (!names.contains(flight)) remove_results(options, flight);
    }
}

}  // namespace

std::vector<BatchFlight> run_batch(const std::vector<LogFile>& logs, const BatchOptions& options,
                                   const BatchProgress& progress) {
    make_directories(flights_folder(options));
    remove_vanished(logs, options);
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

}  // namespace flightwatt
