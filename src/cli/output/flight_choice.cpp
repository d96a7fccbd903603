// Which of the flights that are given are used: by name, by date, and those of folders of flightwatt batch.

#include "base/error.h"
#include "base/input_file.h"
#include "batch/batch_files.h"
#include "batch/batch_fit.h"
#include "batch/log_files.h"
#include "batch/manifest.h"
#include "cli/output/flight_options.h"
#include "flight/flight_identity.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

/// Reason to exclude a flight; empty for one that is used.
std::string why_left_out(const FlightFilter& filter, const std::string& flight) {
    if (!filter.since && !filter.until) return "";
    const auto start = flight::start_in_name(flight);  // of a log that the ground station named after its start
    if (!start) return "its name holds no date (YY_MM_DD__hh_mm_ss)";
    const auto day = std::chrono::floor<std::chrono::days>(*start);
    if (filter.since && day < *filter.since) return "it is before --since";
    if (filter.until && day > *filter.until) return "it is after --until";
    return "";
}

/// Reason why a flight of a batch is not in its fit, by the options of that batch; empty without one.
std::string why_batch_left_out(const std::optional<batch::BatchFit>& fit, const std::string& flight) {
    if (!fit) return "";
    if (fit->excluded.contains(flight)) return "its batch has the option --exclude for it";
    const auto* copy = batch::original_of(flight, fit->copies);
    return copy == nullptr ? "" : "its batch found that it is " + *copy + " under another name";
}

/// A flight of a batch.
struct SeriesFile {
    std::filesystem::path log;  ///< that it was made from
    std::string file;
};

/// The series of the flights that a batch accepted and may fit; --keep overrides the options of the batch.
std::vector<SeriesFile> series_of_batch(const StageCall& call, const std::filesystem::path& out,
                                        const flight::LoadOptions& options) {
    std::vector<SeriesFile> files;
    std::size_t others = 0;
    const auto fit = batch::read_batch_fit(out);
    auto own = options;
    if (fit) own.keep.insert(fit->keep.begin(), fit->keep.end());
    for (const auto& stored : batch::read_stored_flights(out, false)) {
        const auto& record = stored.record;
        const bool is_kept = options.keep.contains(record.flight);
        if (fit && !options.aircraft && !is_kept && fit->other_aircraft.contains(record.flight)) {
            ++others;
            continue;
        }
        const auto left_out = is_kept ? "" : why_batch_left_out(fit, record.flight);
        if (!stored.damage_reason.empty()) {
            warn(call, stored.damage_reason);
        } else if (const auto why = !record.accepted   ? record.error
                                    : left_out.empty() ? batch::exclusion_reason(record, own)
                                                       : left_out;
                   !why.empty() && !options.excluded.contains(record.flight)) {
            if (call.notes)  // the batch has shown it
                add_diagnostic(call, {Severity::note, "not used by the batch", "is not used: " + why, record.flight});
        } else {
            files.push_back({record.log, (out / "flights" / (record.flight + batch::series_suffix)).string()});
        }
    }
    if (others > 0)
        note(call,
             fmt::format("{}: not used, as of other aircraft than its model's: {} of its flights; --aircraft selects "
                         "them",
                         out.string(), others));
    return files;
}

/// Adds those of a batch; a flight that another batch holds too, with the same series, is taken once.
void add_flights_of_batch(const StageCall& call, std::vector<SeriesFile> of_batch,
                          std::map<std::string, std::string>& by_name, std::vector<SeriesFile>& flights) {
    for (auto& flight : of_batch) {
        const auto [other, is_new] = by_name.emplace(flight_of_file(flight.file), flight.file);
        if (is_new || read_file(other->second) != read_file(flight.file))
            flights.push_back(std::move(flight));
        else
            note(call, fmt::format("{} is the same as {}: it is taken once", flight.file, other->second));
    }
}

bool is_of_batch(const std::filesystem::path& folder) { return std::filesystem::exists(folder / batch::manifest_name); }

void add_logs_of_folder(const StageCall& call, const std::string& folder, const flight::LoadOptions& options,
                        std::vector<std::string>& files) {
    for (const auto& log : batch::find_logs({folder}, {}, options.columns)) {
        if (!log.problem.empty())
            skip_input(call, log.path, InputError({log.path}, log.problem));
        else if (!log.why_not_fitted.empty() && !options.keep.contains(log.flight))
            add_diagnostic(call,
                           {Severity::note, "not to be fitted", "is not used: " + log.why_not_fitted, log.flight});
        else
            files.push_back(log.path);
    }
}

}  // namespace

void add_filter_options(Options& options, FlightFilter& filter) {
    options.add("since", filter.since, {.value = "DATE"},
                "flights of this day (2020-07-05) and later, by the date in their names");
    options.add("until", filter.until, {.value = "DATE"}, "flights of this day and before");
    options.add_rule([&filter] {
        if (filter.since && filter.until && *filter.since > *filter.until)
            throw UsageError("--since is after --until: no flight is of both");
    });
}

std::vector<bool> filter_flights(const StageCall& call, const FlightFilter& filter,
                                 const std::vector<std::string>& flights) {
    std::vector<bool> chosen;
    std::string first;
    for (const auto& flight : flights) {
        const auto why = why_left_out(filter, flight);
        chosen.push_back(why.empty());
        if (first.empty() && !why.empty()) first = fmt::format("{} ({})", flight, why);
    }
    const auto left_out = std::ranges::count(chosen, false);
    if (left_out == 0) return chosen;
    if (left_out == std::ssize(flights))
        throw InputError({}, fmt::format("no flight is left of {}: {}", left_out, first), "see --since and --until");
    note(call, fmt::format("{} of {} flights are not used, the first: {}", left_out, flights.size(), first));
    return chosen;
}

std::vector<std::string> files_of(const StageCall& call, const flight::LoadOptions& options) {
    std::vector<std::string> files;
    std::vector<SeriesFile> of_batches;
    std::map<std::string, std::string> by_name;
    for (const auto& input : call.inputs) {
        std::error_code none;
        if (!std::filesystem::is_directory(input, none)) {
            files.push_back(input);
            continue;
        }
        if (!is_of_batch(input)) {
            add_logs_of_folder(call, input, options, files);
            continue;
        }
        add_flights_of_batch(call, series_of_batch(call, input, options), by_name, of_batches);
    }
    // As one batch of all has them, so that the same comes out however they were cut.
    std::ranges::stable_sort(of_batches, {}, &SeriesFile::log);
    for (auto& [log, file] : of_batches) files.push_back(std::move(file));
    if (files.empty()) throw InputError({}, "none of the folders holds a flight that can be used");
    return files;
}

StageCall with_chosen_flights(StageCall call, const FlightFilter& filter, const flight::LoadOptions& options) {
    const auto files = files_of(call, options);
    std::vector<std::string> names;
    names.reserve(files.size());
    for (const auto& file : files) names.push_back(flight_of_file(file));
    const auto chosen = filter_flights(call, filter, names);
    call.inputs.clear();
    for (std::size_t i = 0; i < files.size(); ++i)
        if (chosen[i]) call.inputs.push_back(files[i]);
    return call;
}

std::string flight_of_file(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    const std::string_view series = batch::series_suffix;
    if (name.ends_with(series)) return name.substr(0, name.size() - series.size());
    return telemetry::flight_name(file);
}

}  // namespace flightwatt::cli
