#include "batch/merge.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "base/parallel.h"
#include "batch/batch_files.h"
#include "flight/phases_file.h"
#include "flight/select.h"
#include "flight/series_file.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

/// A flight in the list of a batch.
struct ListedFlight {
    std::filesystem::path from;
    LogFile listed;
};

/// The flights of one batch. Throws InputError for a folder without a finished batch.
std::vector<ListedFlight> flights_of(const std::filesystem::path& batch, const std::set<std::string>& only) {
    std::error_code none;
    if (!std::filesystem::exists(batch / manifest_name, none)) {
        throw InputError({batch.string()}, "not a folder of flightwatt batch: it has no batch.json",
                         "make it with: flightwatt batch LOGS --no-fit -o FOLDER");
    }
    std::vector<ListedFlight> flights;
    for (auto& listed : read_manifest(batch)) {
        if (!only.empty() && !only.contains(listed.flight)) continue;
        if (!std::filesystem::exists(result_path(batch, listed.flight, record_suffix), none)) {
            throw InputError({batch.string()},
                             fmt::format("this batch was not finished: {} has no record", listed.flight),
                             "run its command again to resume");
        }
        flights.push_back({batch, std::move(listed)});
    }
    return flights;
}

/// Throws InputError if the log or the options differ in the second batch.
void require_same(const ListedFlight& one, const ListedFlight& other) {
    const OverwriteExemption own;
    const auto fingerprint = [](const ListedFlight& flight) {
        return read_verified_record(flight.from, flight.listed.flight).fingerprint;
    };
    if (fingerprint(one) == fingerprint(other)) return;
    throw InputError(
        {one.listed.place},
        fmt::format("the batches {} and {} read this log differently: it has changed, or their options differ",
                    one.from.string(), other.from.string()),
        "run one of them again, with the options of the other");
}

/// Sorts by path and removes repeated logs. Returns their number.
std::size_t keep_each_once(std::vector<ListedFlight>& flights) {
    std::ranges::stable_sort(flights, {}, [](const ListedFlight& flight) {
        return std::pair(std::filesystem::path(flight.listed.path), std::filesystem::path(flight.listed.place));
    });
    std::map<std::string, std::size_t> seen;
    std::vector<ListedFlight> kept;
    for (auto& flight : flights) {
        const auto [place, is_new] = seen.emplace(flight.listed.place, kept.size());
        if (is_new)
            kept.push_back(std::move(flight));
        else
            require_same(kept[place->second], flight);
    }
    const auto repeated = flights.size() - kept.size();
    flights = std::move(kept);
    return repeated;
}

/// Throws UsageError for a flight of `out` that is in none of the batches and is not to be dropped.
void drop_others(const std::set<std::string>& places, const std::filesystem::path& out, bool prune, BatchPlan& plan) {
    for (const auto& flight : plan.earlier) {
        if (places.contains(flight.place)) continue;
        plan.dropped.push_back({flight.flight, fmt::format("its log {} is in none of the batches", flight.path)});
    }
    if (plan.dropped.empty() || prune) return;
    throw UsageError(
        fmt::format("{} holds {} flight{} that {} in none of the batches ({}); choose another folder with "
                    "-o, or drop them with --prune",
                    out.string(), plan.dropped.size(), plan.dropped.size() == 1 ? "" : "s",
                    plan.dropped.size() == 1 ? "is" : "are", plan.dropped.front().flight));
}

/// The same flight under another name.
FlightRecord renamed(FlightRecord record, const std::string& name) {
    const auto old = std::exchange(record.flight, name);
    auto& measured = record.measured;
    for (auto& exclusion : measured.exclusions) exclusion.flight.replace(0, old.size(), name);  // NAME or NAME#2
    for (std::size_t i = 0; i < measured.flights.size(); ++i) {
        auto& flight = measured.flights[i];
        flight.samples.flight = mechanical::sortie_name(name, measured.sorties[i] + 1);
        flight.motion.flight = flight.samples.flight;
    }
    return record;
}

/// Whether the flight exists with this record.
bool is_there(const std::filesystem::path& out, const std::string& name, const std::string& record) {
    try {
        std::error_code none;
        const auto file = result_path(out, name, record_suffix);
        if (!std::filesystem::is_regular_file(file, none) || read_file(file) != record) return false;
        read_verified_record(out, name);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// The record last, as a batch does.
void copy_flight(const std::filesystem::path& out, const MergedFlight& source, bool is_accepted) {
    remove_results(out, source.flight);
    for (const auto* ending : {series_suffix, phases_suffix, record_suffix}) {
        if (!is_accepted && ending != std::string_view(record_suffix)) continue;
        link_or_copy_file(result_path(source.from, source.flight, ending), result_path(out, source.flight, ending),
                          out / temporary_folder);
    }
}

void copy_renamed(const std::filesystem::path& out, const MergedFlight& source, const std::string& name,
                  FlightRecord& record) {
    std::string series_text;
    std::string phases_text;
    if (record.accepted) {
        auto series = flight::read_series_csv(result_path(source.from, source.flight, series_suffix));
        const auto phases = flight::read_phases_csv(result_path(source.from, source.flight, phases_suffix));
        series.flight = name;
        series_text = to_csv(series);
        phases_text = flight::phases_csv(select_tracks(series), phases);
    }
    record = renamed(std::move(record), name);
    if (record.accepted) record.results = results_fingerprint(series_text, phases_text);
    const auto write = [&](const char* ending, const std::string& text) {
        write_file_atomically(result_path(out, name, ending), text, out / temporary_folder);
    };
    remove_results(out, name);
    if (record.accepted) {
        write(series_suffix, series_text);
        write(phases_suffix, phases_text);
    }
    write(record_suffix, to_json_text(record));
}

/// Copies a flight of one recording under that name.
BatchFlight merge_recording(const std::filesystem::path& out, const MergedFlight& source, const std::string& name,
                            const flight::LoadOptions& options) {
    const OverwriteExemption own;  // results of batches, not inputs
    const auto text = read_file(result_path(source.from, source.flight, record_suffix));
    auto record = read_verified_record(source.from, source.flight);
    const bool is_up_to_date = name == source.flight && is_there(out, name, text);
    if (name != source.flight) {
        copy_renamed(out, source, name, record);
    } else if (!is_up_to_date) {
        copy_flight(out, source, record.accepted);
    }
    auto merged = without_samples(std::move(record), options);
    merged.was_up_to_date = is_up_to_date;
    return merged;
}

/// Copies the flights of a log, the first recording's under that name.
BatchFlights merge_flight(const std::filesystem::path& out, const MergedFlight& source, const std::string& name,
                          const flight::LoadOptions& options) {
    BatchFlights merged{merge_recording(out, source, name, options)};
    for (const auto number : std::vector(merged.front().record.recordings)) {
        const MergedFlight other{source.from, flight::recording_name(source.flight, number)};
        merged.push_back(merge_recording(out, other, flight::recording_name(name, number), options));
    }
    return merged;
}

}  // namespace

MergePlan plan_merge(const std::vector<std::filesystem::path>& batches, const std::filesystem::path& out, bool prune,
                     const std::set<std::string>& only) {
    MergePlan plan;
    std::vector<ListedFlight> flights;
    for (const auto& batch : batches) {
        std::error_code none;
        if (std::filesystem::equivalent(batch, out, none)) {
            throw UsageError(fmt::format("{} would be read and written; choose another folder with -o", out.string()));
        }
        std::ranges::move(flights_of(batch, only), std::back_inserter(flights));
    }
    plan.duplicate_logs = keep_each_once(flights);
    auto& folder = plan.folder;
    folder.earlier = read_manifest(out);
    UniqueNames names;
    std::set<std::string> places;
    for (auto& [from, listed] : flights) {
        places.insert(listed.place);
        plan.sources.push_back({from.string(), std::move(listed.flight)});
        listed.flight = names.assign(listed.path);
        folder.logs.push_back(std::move(listed));
    }
    folder.flights = folder.logs;
    std::ranges::stable_sort(folder.flights, {}, &LogFile::flight);
    drop_others(places, out, prune, folder);
    return plan;
}

BatchFlights merge_flights(const MergePlan& plan, const std::filesystem::path& out, const BatchProgress& progress,
                           const flight::LoadOptions& options) {
    make_directories(out / temporary_folder);
    std::vector<BatchFlights> of_logs(plan.sources.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    for_each_in_parallel(of_logs.size(), [&](std::size_t i) {
        of_logs[i] = merge_flight(out, plan.sources[i], plan.folder.logs[i].flight, options);
        const std::lock_guard lock(mutex);
        ++done;
        for (const auto& flight : of_logs[i]) progress(done, of_logs.size(), flight);
    });
    return joined(std::move(of_logs));
}

BatchFlights copy_flights(const std::filesystem::path& from, const std::set<std::string>& flights,
                          const BatchOptions& to) {
    make_directories(to.out);
    auto plan = plan_merge({from}, to.out, true, flights);
    plan.folder.is_of_each = true;
    refuse_foreign_files(plan.folder, to.out);
    const RemoveIfEmpty unfinished{to.out / temporary_folder};
    prepare_folder(plan.folder, to.out);
    return merge_flights(
        plan, to.out, [](std::size_t, std::size_t, const BatchFlight&) {}, to.load);
}

}  // namespace flightwatt::batch
