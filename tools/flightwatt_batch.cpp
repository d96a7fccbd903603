// flightwatt batch: parse and segment every log, incrementally, and fit them.

#include "base/atomic_file.h"
#include "base/overwrite_guard.h"
#include "batch/batch_files.h"
#include "batch/batch_fit.h"
#include "batch/batch_run.h"
#include "batch/manifest.h"
#include "batch/merge.h"
#include "cli/output/aircraft_choice.h"
#include "cli/output/fit_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/physical_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <set>
#include <span>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

struct BatchArguments {
    cli::FitArguments model;
    cli::FlightArguments flights;
    cli::FlightFilter filter;
    std::optional<std::string> files_from;
    bool no_fit = false;
    bool prune = false;
};

/// Updates the progress bar, or prints the state of the log.
batch::BatchProgress progress_of(const cli::StageCall& call, cli::ProgressBar& bar) {
    return [&](std::size_t done, std::size_t all, const batch::BatchFlight& flight) {
        if (cli::standard_error_terminal() != nullptr) return bar.show(done, all);
        const auto* what = flight.record.is_of_other_aircraft ? "not used, of another aircraft"
                           : !flight.record.accepted          ? "not used"
                           : flight.log_is_missing            ? "kept, its log is missing"
                           : flight.was_up_to_date            ? "up to date"
                                                              : "done";
        cli::note(call, fmt::format("[{}/{}] {}: {}", done, all, flight.record.flight, what));
    };
}

Diagnostic rejection_of(const batch::FlightRecord& record) {
    const auto reason = reason_without_log(record);
    if (record.is_of_other_aircraft)
        return {Severity::note, "of another aircraft", "not used: " + reason, record.flight};
    if (!record.recordings.empty()) return {Severity::note, "recordings without a flight", reason, record.flight};
    const auto place = reason.starts_with(record.log) ? reason.find(": ") : std::string::npos;  // with a line
    const auto kind = kind_of_reason(place == std::string::npos ? reason : reason.substr(place + 2));
    return {Severity::error, "not used: " + kind, "not used: " + record.error, record.flight};
}

void collect_diagnostics(const cli::StageCall& call, const batch::BatchFlight& flight) {
    if (flight.is_of_other_aircraft) return;
    const auto& record = flight.record;
    for (const auto& [severity, kind, text, none] : record.diagnostics)
        cli::add_diagnostic(call, {severity, kind, text, record.flight});
    if (record.no_power_reason.empty())  // which has a diagnostic of its own
        for (const auto& exclusion : flight.selection.exclusions)
            cli::add_diagnostic(call, cli::diagnostic_of(exclusion));
    if (!record.accepted) cli::add_diagnostic(call, rejection_of(record));
}

/// Without a fit no model of an earlier run stays behind to be taken for this one's.
void remove_model(const cli::StageCall& call, const std::filesystem::path& out) {
    const auto removed = batch::remove_batch_fit(out);
    if (removed.empty()) return;
    cli::note(call, fmt::format("removed: {}: they are an earlier run's, and this one has no model for {}",
                                fmt::join(removed, ", "), out.string()));
}

/// A fit with its Table I, and how its physical model came about, where one was asked for.
struct FittedBatch {
    batch::BatchFit fit;
    TextTable table;
    std::optional<mechanical::PhysicalFit> physical;
};

/// Fits what the batch accepted, and writes the model and its Table I; std::nullopt, with a note, if nothing is to be
/// fitted.
std::optional<FittedBatch> fit_batch(const cli::StageCall& call, const BatchArguments& arguments,
                                     const batch::BatchFlights& flights, const batch::BatchOptions& batch,
                                     const cli::ChosenAircraft& flown, std::vector<batch::DuplicateFlight> copies,
                                     const std::optional<mechanical::MechanicalModel>& published) {
    const auto totals = totals_of(flights);
    if (totals.accepted == 0) {
        throw InputError({},
                         fmt::format("none of the {} logs can be used, so there is nothing to fit", flights.size()));
    }
    if (totals.with_power == 0) {
        cli::warn(call, "no flight has measured power: nothing was fitted, and there is no model");
        return std::nullopt;
    }
    if (arguments.no_fit) {
        cli::note(call, "nothing was fitted");
        return std::nullopt;
    }
    if (flown.groups.size() > 1 && !batch.load.aircraft && !arguments.flights.mix_aircraft)
        throw NoResultError("the catalogue is written, and no model: " +
                            cli::show_aircraft(call, flown.groups, flown.flights, true));
    const auto& options = arguments.model.fit;
    const auto kind = arguments.model.kind;
    auto measured = read_samples(flights, batch);
    std::vector<mechanical::FlightSamples> samples;
    samples.reserve(measured.size());
    for (auto& flight : measured)
        samples.push_back(std::move(flight.samples));  // of thousands, two copies are too many
    FittedBatch fitted{batch::fit_flights(samples, options), {}, {}};
    auto& fit = fitted.fit;
    if (kind == cli::ModelKind::physical) fitted.physical = cli::fit_motion(call, measured, fit.model);
    for (std::size_t i = 0; i < measured.size(); ++i) measured[i].samples = std::move(samples[i]);
    if (kind != cli::ModelKind::fourier) cli::add_best_power(measured, options, fit.model);
    fit.copies = std::move(copies);
    fit.excluded = batch.load.excluded;
    fit.keep = batch.load.keep;
    fit.other_aircraft = flown.others;
    fitted.table = cli::model_table(fit.model, published);
    for (const auto* name : batch::table_names)
        write_file_atomically(batch.out / name, cli::table_text(fitted.table, name),
                              batch.out / batch::temporary_folder);
    write_batch_fit(fit, batch.out);
    return fitted;
}

}  // namespace

namespace flightwatt::batch {

Fields<BatchFlight> record_fields(const BatchFlight*) {
    using R = BatchFlight;
    return {field("flight", at(&R::record, &FlightRecord::flight), "name of the flight"),
            field("accepted", at(&R::record, &FlightRecord::accepted), "the log is usable"),
            field("was_up_to_date", &R::was_up_to_date, "it was not read again"),
            field("error", at(&R::record, &FlightRecord::error), "reason of a rejected log")};
}

}  // namespace flightwatt::batch

namespace {

/// JSON of the stage.
struct BatchOutput {
    const cli::FitOutput* fit = nullptr;
    const std::vector<cli::AircraftFolder>* each = nullptr;
    const batch::BatchFlights* logs = nullptr;
};

Fields<BatchOutput> record_fields(const BatchOutput*) {
    using R = BatchOutput;
    return list_fields<R>(embedded_if_any(at(&R::fit)),
                          field("aircraft", &R::each, "of --each: folder of each aircraft", optional_key{}),
                          field("logs", &R::logs, "all logs of the folder"));
}

/// The table of the flights, or of the first 1000 of them.
std::string flights_text(const cli::StageCall& call, const batch::BatchFlights& flights,
                         std::span<const batch::AircraftGroup> groups, const batch::BatchOptions& options) {
    constexpr std::size_t max_logs = 1000;
    cli::ScreenTable shown_first{fmt::format("{}: {} logs", options.out.string(), flights.size()),
                                 {"flight", "cruise s", "cruise W", "energy Wh", "phases fitted", "take-off s",
                                  "landing s", "take-off W", "landing W", "warnings", "gaps", "longest s"}};
    if (groups.size() > 1) shown_first.first.insert(shown_first.first.begin() + 1, "aircraft");
    auto text = screen_text(flights_table(flights, max_logs, short_ids(groups)), screen_of(call), shown_first);
    if (flights.size() > max_logs) {
        text += fmt::format("the first {} of {} logs; {} has all\n", max_logs, flights.size(),
                            (options.out / batch::catalogue_name).string());
    }
    return text;
}

/// 3 if a log of this run was rejected.
int exit_code(const cli::StageCall& call, const batch::Totals& totals) {
    if (totals.rejected_of_this_run == 0) return cli::ok;
    cli::note(call, fmt::format("{} of {} logs not used; the others are done", totals.rejected_of_this_run,
                                totals.of_this_run));
    return cli::input_rejected;
}

/// Writes the catalogue and the fit of a folder, then prints them, so that a closed standard output loses no file.
std::optional<FittedBatch> finish_folder(const cli::StageCall& call, const BatchArguments& arguments,
                                         batch::BatchFlights& flights, const batch::BatchOptions& options,
                                         const std::optional<mechanical::MechanicalModel>& published) {
    const auto copies = find_duplicates(flights);
    exclude_duplicates(flights, copies);
    const auto flown = cli::choose_aircraft(call, options.load.aircraft, flights);
    for (const auto& flight : flights) collect_diagnostics(call, flight);
    write_file_atomically(options.out / batch::catalogue_name, catalogue_csv(flights),
                          options.out / batch::temporary_folder);
    const auto shown = flights_text(call, flights, flown.groups, options);
    std::optional<FittedBatch> fitted;
    try {
        fitted = fit_batch(call, arguments, flights, options, flown, copies, published);
    } catch (const std::exception&) {
        remove_model(call, options.out);
        if (!call.json) cli::print(shown);
        throw;
    }
    if (fitted)
        warn_of_model(call, fitted->fit.model);
    else
        remove_model(call, options.out);
    if (call.json) return fitted;
    const auto screen = screen_of(call);
    cli::print(shown);
    if (!fitted) return fitted;
    const bool has_details = call.notes || published;
    cli::print("\n" + (has_details ? screen_text(fitted->table, screen, {"Table I", {}})
                                   : screen_text(cli::mean_power_table(fitted->fit.model), screen,
                                                 {"mean power of the phases; --notes: Table I", {}})));
    if (fitted->physical && has_details)
        cli::print("\n" + cli::physical_text(*fitted->physical, screen));
    else if (fitted->physical && fitted->physical->speeds)
        cli::print(fmt::format("\nSpeed to fly\n{}\n", fmt::join(cli::speed_lines(*fitted->physical->speeds), "\n")));
    return fitted;
}

/// Finishes the folder of a run. Returns the exit code.
int finish(const cli::StageCall& call, const BatchArguments& arguments, batch::BatchFlights flights,
           const batch::BatchOptions& options, const std::optional<mechanical::MechanicalModel>& published) {
    const auto fitted = finish_folder(call, arguments, flights, options, published);
    if (call.json) {
        std::optional<cli::FitOutput> fit;
        if (fitted) fit = cli::FitOutput{&fitted->fit.model, fitted->physical ? &*fitted->physical : nullptr};
        cli::print_json(call, BatchOutput{fit ? &*fit : nullptr, nullptr, &flights});
    }
    const auto code = exit_code(call, totals_of(flights));
    return fitted || arguments.no_fit ? code : cli::no_answer;
}

/// Makes a batch of the flights of one aircraft, from the folder of all, with its fit.
cli::AircraftFolder finish_one(const cli::StageCall& call, const BatchArguments& arguments,
                               const batch::AircraftGroup& group, const cli::ChosenAircraft& flown,
                               const batch::BatchOptions& all,
                               const std::optional<mechanical::MechanicalModel>& published) {
    auto options = all;
    options.out = all.out / cli::file_name_of(group.selector);
    cli::AircraftFolder made{group.selector, options.out.string(), {}, false};
    for (const auto number : group.flights) made.flights.push_back(flown.flights[number].flight);
    auto flights = batch::copy_flights(all.out, {made.flights.begin(), made.flights.end()}, options);
    if (!call.json) cli::print(fmt::format("{}:\n", made.folder));
    try {
        made.has_model = finish_folder(call, arguments, flights, options, published).has_value();
    } catch (const NoResultError& error) {
        cli::warn(call, fmt::format("{}: no model: {}", made.folder, error.what()));
    }
    return made;
}

/// Makes a batch of each aircraft in the folder of all flights. Returns the exit code.
int finish_each(const cli::StageCall& call, const BatchArguments& arguments, batch::BatchFlights flights,
                const batch::BatchOptions& options, const std::optional<mechanical::MechanicalModel>& published) {
    exclude_duplicates(flights, find_duplicates(flights));
    write_file_atomically(options.out / batch::catalogue_name, catalogue_csv(flights),
                          options.out / batch::temporary_folder);
    remove_model(call, options.out);
    const auto flown = cli::choose_aircraft(call, options.load.aircraft, flights);
    for (const auto& flight : flights)
        if (flight.selection.flights.empty()) collect_diagnostics(call, flight);
    if (flown.groups.empty()) throw InputError({}, "no flight can be fitted", "see the reasons above");
    std::vector<cli::AircraftFolder> made;
    for (const auto& group : cli::certain_aircraft(call, flown.groups, flown.flights))
        made.push_back(finish_one(call, arguments, group, flown, options, published));
    if (call.json) cli::print_json(call, BatchOutput{nullptr, &made, &flights});
    const auto code = exit_code(call, totals_of(flights));
    const bool any_failed = std::ranges::any_of(made, [](const auto& one) { return !one.has_model; });
    return any_failed ? cli::no_answer : code;
}

std::vector<batch::LogFile> chosen_logs(const cli::StageCall& call, const cli::FlightFilter& filter,
                                        std::vector<batch::LogFile> logs) {
    std::vector<std::string> names(logs.size());
    std::ranges::transform(logs, names.begin(), &batch::LogFile::flight);
    const auto chosen = cli::filter_flights(call, filter, names);
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
batch::BatchPlan make_plan(const cli::StageCall& call, const BatchArguments& arguments,
                           const batch::BatchOptions& options) {
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
    cli::refuse_unknown_flights(without_recordings(options.load), names);
    return plan;
}

void tell_plan(const cli::StageCall& call, const batch::BatchPlan& plan) {
    for (const auto& dropped : plan.dropped) {
        cli::note(call, fmt::format("dropped: {}, {}", dropped.flight, dropped.reason));
    }
    const auto earlier = std::ranges::count(plan.logs, false, &batch::LogFile::is_of_this_run);
    if (earlier == 0) return;
    cli::note(call,
              fmt::format("{} flights of earlier runs stay in {}; --prune drops what is not among this run's logs",
                          earlier, *call.output));
    for (const auto& log : plan.logs)
        if (log.is_missing)
            cli::note(call, fmt::format("{}: its log {} is missing; its results are kept", log.flight, log.path));
}

/// Results among the logs would be taken for logs.
void refuse_folder_of_logs(const cli::StageCall& call) {
    for (const auto& input : call.inputs) {
        std::error_code none;
        if (std::filesystem::equivalent(input, *call.output, none))
            throw UsageError(fmt::format("--output {} is the folder of the logs: name another, such as {}-results",
                                         *call.output, *call.output));
    }
}

int run_over_logs(const cli::StageCall& call, const BatchArguments& arguments) {
    if (call.inputs.empty() && !arguments.files_from)
        throw UsageError("no log given: expected LOG, FOLDER or --files-from LIST");
    if (!call.output) throw UsageError("no folder for the results: expected -o DIR");
    refuse_folder_of_logs(call);
    batch::BatchOptions options;
    options.out = *call.output;
    options.load = arguments.flights.load;
    options.load.aircraft_required = false;
    const auto published = read_published(arguments.model);
    make_directories(options.out);
    const batch::FolderLock lock(options.out);
    const batch::RemoveIfEmpty folder{options.out};  // where nothing can be done
    auto plan = make_plan(call, arguments, options);
    tell_plan(call, plan);
    prepare_folder(plan, options.out);
    const batch::RemoveIfEmpty unfinished{options.out / batch::temporary_folder};
    cli::ProgressBar bar("logs");
    auto flights = run_batch(plan.logs, options, progress_of(call, bar));
    bar.hide();
    std::vector<std::string> names;
    for (const auto& flight : flights) names.push_back(flight.record.flight);
    cli::refuse_unknown_flights(options.load, names);
    return arguments.flights.each ? finish_each(call, arguments, std::move(flights), options, published)
                                  : finish(call, arguments, std::move(flights), options, published);
}

}  // namespace

int flightwatt::stages::batch_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "batch", "LOG|FOLDER... -o OUT",
        R"(Parses and segments every log (.data, .bin, .ulg, CSV; folders are searched to the bottom) into OUT/flights, several at a
time, and fits them: OUT/model.toml, OUT/table1.txt, .csv, .md, and OUT/flights.csv, a row a flight and
phase. Logs whose results are up to date are not done again. A log that cannot be used is reported and the
others are processed; the exit code is then 3. Flights of earlier runs into OUT stay, also those whose log is missing;
--prune drops what is not among the logs that are given. A folder that has files of these names, but no
OUT/batch.json, is refused. Logs of a folder below FOLDER that holds a file not-fitted.txt are
listed and excluded from the fit; its first line states the reason.

Of flights of several aircraft, --aircraft fits those of one. --each makes the folder of a batch for each of them.

It may be ended at any time (Ctrl-C): the same command continues where it stopped, with the same results.)"};
    stage.examples = {"flightwatt batch logs -o my",
                      "flightwatt batch logs -o my --aircraft 5 --since 2020-07-01 --prune"};
    stage.min_inputs = 0;  // or --files-from
    stage.next = [](const auto& call) {
        std::error_code none;
        if (std::filesystem::exists(std::filesystem::path(*call.output) / "model.toml", none))
            return "flightwatt battery {} --capacity AH -o pack.toml";
        if (call.has("each")) return "flightwatt battery {}/AIRCRAFT --capacity AH -o pack.toml";
        return call.has("no-fit") ? "flightwatt fit {} -o MODEL.toml" : "";
    };
    stage.json_schema = [] {
        auto schema = cli::document_schema<BatchOutput>();
        schema["$defs"][batch::catalogue_name] = batch::catalogue_schema();
        return schema;
    };
    stage.uses_threads = stage.shows_table = true;
    stage.output_value = "DIR";
    stage.output_help = "the folder of the results";
    BatchArguments arguments;
    arguments.model.fit.name = "batch";
    auto& options = stage.options;
    cli::add_model_options(options, arguments.model);
    options.add("name", arguments.model.fit.name, {.value = "NAME"}, "the model's name");
    options.add("files-from", arguments.files_from, cli::input_file("LIST"),
                "also the logs that LIST names, one path a line; - is the standard input. A missing log is rejected");
    options.add("no-fit", arguments.no_fit,
                "write OUT/flights and OUT/flights.csv alone: flightwatt fit fits the folders of several batches");
    cli::add_each_option(options, arguments.flights,
                         "a folder OUT/AIRCRAFT for each aircraft, with its flights and its model", {"no-fit"});
    options.add("prune", arguments.prune, "drop the flights of earlier runs that are not among the logs given");
    cli::add_filter_options(options, arguments.filter);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return run_over_logs(call, arguments); });
}
