#include "cli/output/batch_folder.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "batch/manifest.h"
#include "batch/merge.h"
#include "cli/output/fit_output.h"
#include "cli/output/physical_output.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

Diagnostic rejection_of(const batch::FlightRecord& record) {
    const auto reason = reason_without_log(record);
    if (record.is_of_other_aircraft)
        return {Severity::note, "of another aircraft", "not used: " + reason, record.flight};
    if (!record.recordings.empty()) return {Severity::note, "recordings without a flight", reason, record.flight};
    const auto place = reason.starts_with(record.log) ? reason.find(": ") : std::string::npos;  // with a line
    const auto kind = kind_of_reason(place == std::string::npos ? reason : reason.substr(place + 2));
    return {Severity::error, "not used: " + kind, "not used: " + record.error, record.flight};
}

std::vector<batch::LogFile> chosen_logs(const StageCall& call, const FlightFilter& filter,
                                        std::vector<batch::LogFile> logs) {
    std::vector<std::string> names(logs.size());
    std::ranges::transform(logs, names.begin(), &batch::LogFile::flight);
    const auto chosen = filter_flights(call, filter, names);
    std::size_t number = 0;
    std::erase_if(logs, [&](const batch::LogFile&) { return !chosen[number++]; });
    return logs;
}

/// The paths of --files-from; none without it.
std::vector<std::string> listed_logs(const std::optional<std::string>& list) {
    if (!list) return {};
    const auto file = *list == "-" ? std::string("the standard input") : *list;
    const auto text = *list == "-" ? std::string(std::istreambuf_iterator<char>(std::cin), {}) : read_file(*list);
    auto paths = batch::parse_path_list(text, file);
    if (paths.empty()) {
        throw InputError({file}, "names no log", "expected the path of a log in each line");
    }
    return paths;
}

/// Without the names of recordings behind the first, which are known after the run.
flight::LoadOptions without_recordings(flight::LoadOptions options) {
    std::erase_if(options.excluded, flight::is_recording_name);
    std::erase_if(options.keep, flight::is_recording_name);
    return options;
}

/// The changes of the run to the folder, before it makes them.
batch::BatchPlan make_plan(const StageCall& call, const BatchArguments& arguments, const batch::BatchOptions& options) {
    auto logs =
        chosen_logs(call, arguments.filter,
                    batch::find_logs(call.inputs, listed_logs(arguments.files_from), arguments.flights.load.columns));
    for (const auto& log : logs) {
        register_input(log.path);
        if (const auto file = telemetry::find_log_file(log.path)) register_input(*file);
    }
    auto plan = batch::plan_batch(std::move(logs), options.out, arguments.prune);
    refuse_foreign_files(plan, options.out);
    std::vector<std::string> names;
    names.reserve(plan.logs.size());
    for (const auto& log : plan.logs) names.push_back(log.flight);
    refuse_unknown_flights(without_recordings(options.load), names);
    return plan;
}

/// Notes what a run drops from the folder, and what stays in it.
void note_plan(const StageCall& call, const batch::BatchPlan& plan, const batch::BatchOptions& options) {
    for (const auto& dropped : plan.dropped) {
        note(call, fmt::format("dropped: {}, {}", dropped.flight, dropped.reason));
    }
    const auto earlier = std::ranges::count(plan.logs, false, &batch::LogFile::is_of_this_run);
    if (earlier == 0) return;
    note(call, fmt::format("{} flights of earlier runs stay in {}; --prune drops what is not among this run's logs",
                           earlier, options.out.string()));
    for (const auto& log : plan.logs)
        if (log.is_missing)
            note(call, fmt::format("{}: its log {} is missing; its results are kept", log.flight, log.path));
}

/// Fits with the options of `fitted`.
void fit_measured(const StageCall& call, ModelKind kind, std::vector<mechanical::MeasuredFlight> measured,
                  FittedBatch& fitted) {
    std::vector<mechanical::FlightSamples> samples;
    samples.reserve(measured.size());
    for (auto& flight : measured)
        samples.push_back(std::move(flight.samples));  // of thousands, two copies are too many
    auto& fit = fitted.fit;
    auto of_samples = batch::fit_flights(samples, fit.options);
    fit.model = std::move(of_samples.model);
    fit.bands = std::move(of_samples.bands);
    if (kind == ModelKind::physical) fitted.physical = fit_motion(call, measured, fit.model);
    for (std::size_t i = 0; i < measured.size(); ++i) measured[i].samples = std::move(samples[i]);
    if (kind != ModelKind::fourier) add_best_power(measured, fit.options, fit.model);
}

bool is_there(const std::filesystem::path& folder) {
    std::error_code none;
    return std::filesystem::exists(folder, none);
}

const std::filesystem::path& made(const std::filesystem::path& folder) {
    make_directories(folder);
    return folder;
}

}  // namespace

BatchFolder::BatchFolder(const std::filesystem::path& out) : BatchFolder(out, is_there(out)) {}

BatchFolder::BatchFolder(const std::filesystem::path& out, bool was_there)
    : lock_(made(out)), if_empty_{was_there ? std::filesystem::path() : out} {}

void refuse_folder_of_logs(const StageCall& call, const std::string& out) {
    for (const auto& input : call.inputs) {
        std::error_code none;
        if (std::filesystem::equivalent(input, out, none))
            throw UsageError(
                fmt::format("--output {} is the folder of the logs: name another, such as {}-results", out, out));
    }
}

batch::BatchOptions batch_options(const BatchArguments& arguments, const std::filesystem::path& out) {
    batch::BatchOptions options{out, arguments.flights.load};
    options.load.aircraft_required = false;
    return options;
}

batch::BatchFlights read_logs(const StageCall& call, const BatchArguments& arguments,
                              const batch::BatchOptions& options, const batch::BatchProgress& progress) {
    auto plan = make_plan(call, arguments, options);
    if (arguments.note_changes) note_plan(call, plan, options);
    prepare_folder(plan, options.out);
    const batch::RemoveIfEmpty unfinished{options.out / batch::temporary_folder};
    auto flights = run_batch(plan.logs, options, progress);
    std::vector<std::string> names;
    for (const auto& flight : flights) names.push_back(flight.record.flight);
    refuse_unknown_flights(options.load, names);
    return flights;
}

void add_diagnostics(const StageCall& call, const batch::BatchFlight& flight) {
    if (flight.is_of_other_aircraft) return;
    const auto& record = flight.record;
    for (const auto& [severity, kind, text, none] : record.diagnostics)
        add_diagnostic(call, {severity, kind, text, record.flight});
    if (record.no_power_reason.empty())  // which has a diagnostic of its own
        for (const auto& exclusion : flight.selection.exclusions) add_diagnostic(call, diagnostic_of(exclusion));
    if (!record.accepted) add_diagnostic(call, rejection_of(record));
}

ListedFlights list_flights(const StageCall& call, batch::BatchFlights& flights, const batch::BatchOptions& options) {
    ListedFlights listed{find_duplicates(flights), {}};
    exclude_duplicates(flights, listed.copies);
    listed.flown = choose_aircraft(call, options.load.aircraft, flights);
    for (const auto& exclusion : exclude_hover(flights, options.load.keep))
        add_diagnostic(call, diagnostic_of(exclusion));
    write_file_atomically(options.out / batch::catalogue_name, catalogue_csv(flights),
                          options.out / batch::temporary_folder);
    return listed;
}

std::optional<FittedBatch> fit_folder(const StageCall& call, const BatchArguments& arguments,
                                      const batch::BatchFlights& flights, const batch::BatchOptions& batch,
                                      const ListedFlights& listed,
                                      const std::optional<mechanical::MechanicalModel>& published) {
    const auto& flown = listed.flown;
    const auto totals = totals_of(flights);
    if (totals.accepted == 0) {
        throw InputError({},
                         fmt::format("none of the {} logs can be used, so there is nothing to fit", flights.size()));
    }
    if (totals.with_power == 0) {
        warn(call, "no flight has measured power: nothing was fitted, and there is no model");
        return std::nullopt;
    }
    if (arguments.no_fit) {
        note(call, "nothing was fitted");
        return std::nullopt;
    }
    if (flown.groups.size() > 1 && !batch.load.aircraft && !arguments.flights.mix_aircraft)
        throw NoResultError("the catalogue is written, and no model: " +
                            show_aircraft(call, flown.groups, flown.flights, true));
    FittedBatch fitted{
        {arguments.model.fit, batch.load.excluded, batch.load.keep, listed.copies, flown.others, {}, {}, {}}, {}, {}};
    // How a physical model came about is in no file.
    if (arguments.model.kind != ModelKind::physical)
        fitted.fit.key = fmt::format("{} {}", fit_key(flights, fitted.fit), static_cast<int>(arguments.model.kind));
    auto unchanged = fitted.fit.key.empty() ? std::nullopt : batch::unchanged_batch_fit(batch.out, fitted.fit.key);
    if (unchanged) {
        fitted.fit.model = std::move(unchanged->model);
        fitted.fit.bands = std::move(unchanged->bands);
    } else {
        fit_measured(call, arguments.model.kind, read_samples(flights, batch), fitted);
    }
    fitted.table = model_table(fitted.fit.model, published);
    for (const auto* name : batch::table_names)
        write_file_atomically(batch.out / name, table_text(fitted.table, name), batch.out / batch::temporary_folder);
    write_batch_fit(fitted.fit, batch.out);
    return fitted;
}

void remove_model(const StageCall& call, const std::filesystem::path& out) {
    const auto removed = batch::remove_batch_fit(out);
    if (removed.empty()) return;
    note(call, fmt::format("removed: {}: they are an earlier run's, and this one has no model for {}",
                           fmt::join(removed, ", "), out.string()));
}

void settle_folders_of_each(const StageCall& call, const std::filesystem::path& out,
                            const std::vector<batch::AircraftGroup>& aircraft, bool prune) {
    std::set<std::filesystem::path> made;
    for (const auto& group : aircraft) made.insert(out / file_name_of(group.selector));
    for (const auto& folder : batch::folders_of_each(out)) {
        if (made.contains(folder)) continue;
        if (prune) batch::remove_batch(folder);
        prune ? note(call, fmt::format("removed: {}, of an earlier run: no flight is of its aircraft", folder.string()))
              : warn(call, fmt::format("{} and its model are an earlier run's: no flight is of its aircraft now; "
                                       "--prune removes it",
                                       folder.string()));
    }
}

batch::BatchFlights separate_aircraft(const batch::AircraftGroup& group, const ChosenAircraft& flown,
                                      batch::BatchOptions& options) {
    const auto all = std::exchange(options.out, options.out / file_name_of(group.selector));
    std::set<std::string> flights;
    for (const auto number : group.flights) flights.insert(flown.flights[number].flight);
    return batch::copy_flights(all, flights, options);
}

}  // namespace flightwatt::cli
