#include "batch/batch_files.h"

#include "base/error.h"
#include "base/fingerprint.h"
#include "base/input_file.h"
#include "base/overwrite_guard.h"
#include "base/parallel.h"
#include "base/text.h"
#include "batch/manifest.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

/// The flights that the batch's manifest lists and that have a record.
std::vector<LogFile> stored_flights(const std::filesystem::path& out) {
    auto flights = read_manifest(out);
    std::error_code none;
    std::erase_if(flights, [&](const LogFile& flight) {
        return !std::filesystem::exists(result_path(out, flight.flight, record_suffix), none);
    });
    return flights;
}

struct IntactFlight {
    FlightRecord record;
    std::string series_csv;  ///< of an accepted log
};

/// Throws InputError for files that have changed since the batch.
IntactFlight read_intact(const std::filesystem::path& out, const std::string& flight) {
    const auto file = result_path(out, flight, record_suffix);
    const std::string hint = "run flightwatt batch again";
    auto record = record_from_json(read_file(file));
    if (!record) {
        throw InputError({file.string()}, "not a flight record of this version: it was changed or damaged", hint);
    }
    if (record->flight != valid_utf8(flight)) {
        throw InputError({file.string()}, fmt::format("this is the record of {}: the file was renamed", record->flight),
                         hint);
    }
    record->flight = flight;
    IntactFlight intact{*std::move(record), {}};
    if (!intact.record.accepted) return intact;
    const auto series = result_path(out, flight, series_suffix);
    const auto phases = result_path(out, flight, phases_suffix);
    std::error_code none;
    const bool are_there =
        std::filesystem::is_regular_file(series, none) && std::filesystem::is_regular_file(phases, none);
    if (are_there) intact.series_csv = read_file(series, flight::max_series_bytes);
    if (!are_there || intact.record.results != results_fingerprint(intact.series_csv, read_file(phases)))
        throw InputError({series.string()}, "the series or its phases have changed since the batch", hint);
    return intact;
}

/// The record, and on request series and phases; damaged files without their log give a damage_reason.
StoredFlight read_recorded(const std::filesystem::path& out, const LogFile& listed, bool with_series) {
    const auto& name = listed.flight;
    // No result may replace the log itself.
    register_input(listed.place);
    if (const auto configuration = telemetry::find_log_file(listed.place)) register_input(*configuration);
    StoredFlight flight;
    try {
        auto [record, series_csv] = read_intact(out, name);
        flight.record = std::move(record);
        if (with_series && flight.record.accepted) {
            const auto folder = out / "flights";
            flight.series = flight::parse_series_csv(series_csv, folder / (name + series_suffix));
            flight.series.flight = name;
            flight.phases = flight::read_phases_csv(folder / (name + phases_suffix));
        }
    } catch (const InputError& error) {
        std::error_code none;
        if (std::filesystem::exists(listed.place, none)) throw;
        flight = {};
        flight.record.flight = name;
        flight.record.log = listed.path;
        flight.damage_reason = fmt::format("{}: {}, and its log is missing", to_string(error.where()), error.what());
    }
    return flight;
}

/// The flights of a log, the first recording's first.
std::vector<StoredFlight> read_log_flights(const std::filesystem::path& out, const LogFile& listed, bool with_series) {
    std::vector<StoredFlight> flights{read_recorded(out, listed, with_series)};
    for (const auto number : std::vector(flights.front().record.recordings)) {
        auto other = listed;
        other.flight = flight::recording_name(listed.flight, number);
        flights.push_back(read_recorded(out, other, with_series));
    }
    return flights;
}

}  // namespace

std::string results_fingerprint(std::string_view series_csv, std::string_view phases_csv) {
    Fingerprint fingerprint;
    fingerprint.add(series_csv);
    fingerprint.add(phases_csv);
    return fingerprint.hex();
}

FlightRecord read_verified_record(const std::filesystem::path& out, const std::string& flight) {
    return read_intact(out, flight).record;
}

FlightRecords read_verified_records(const std::filesystem::path& out, const std::string& flight) {
    FlightRecords records{read_verified_record(out, flight)};
    for (const auto number : std::vector(records.front().recordings))
        records.push_back(read_verified_record(out, flight::recording_name(flight, number)));
    return records;
}

std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out, bool with_series) {
    const auto folder = out / "flights";
    std::error_code none;
    if (!std::filesystem::exists(out / manifest_name, none)) {
        throw InputError({out.string()}, "not a folder of flightwatt batch: it has no batch.json",
                         fmt::format("make it with: flightwatt batch LOGS -o {}", out.string()));
    }
    register_input(out / manifest_name);
    register_input(out / catalogue_name);
    for (const auto* name : model_names) register_input(out / name);
    const auto listed = stored_flights(out);
    std::vector<std::vector<StoredFlight>> of_logs(listed.size());
    for_each_in_parallel(listed.size(),
                         [&](std::size_t i) { of_logs[i] = read_log_flights(out, listed[i], with_series); });
    std::vector<StoredFlight> flights;
    for (auto& of_log : of_logs) std::ranges::move(of_log, std::back_inserter(flights));
    if (flights.empty()) {
        throw InputError({folder.string()}, "it has no flight record",
                         fmt::format("make them with: flightwatt batch LOGS -o {}", out.string()));
    }
    return flights;
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ < 0) {
        throw OutputError(fmt::format("cannot open the folder {}: {}", folder.string(), std::strerror(errno)));
    }
    if (::flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(folder_);
    throw OutputError(
        fmt::format("another run is writing into {}; wait for it, or choose another folder", folder.string()));
}

RemoveIfEmpty::~RemoveIfEmpty() {
    std::error_code ignored;
    std::filesystem::remove(folder, ignored);
}

FolderLock::~FolderLock() { ::close(folder_); }

}  // namespace flightwatt::batch
