// flightwatt batch: parse and segment every log, incrementally, and fit them.

#include "base/atomic_file.h"
#include "batch/batch_run.h"
#include "batch/manifest.h"
#include "cli/output/aircraft_choice.h"
#include "cli/output/batch_folder.h"
#include "cli/output/fit_output.h"
#include "cli/output/physical_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>
#include <span>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

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
std::optional<cli::FittedBatch> finish_folder(const cli::StageCall& call, const cli::BatchArguments& arguments,
                                              batch::BatchFlights& flights, const batch::BatchOptions& options,
                                              const std::optional<mechanical::MechanicalModel>& published) {
    const auto listed = list_flights(call, flights, options);
    for (const auto& flight : flights) add_diagnostics(call, flight);
    const auto shown = flights_text(call, flights, listed.flown.groups, options);
    std::optional<cli::FittedBatch> fitted;
    try {
        fitted = fit_folder(call, arguments, flights, options, listed, published);
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
    if (fitted->physical) cli::print("\n" + cli::physical_text(*fitted->physical, screen));
    return fitted;
}

/// Finishes the folder of a run. Returns the exit code.
int finish(const cli::StageCall& call, const cli::BatchArguments& arguments, batch::BatchFlights flights,
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
cli::AircraftFolder finish_one(const cli::StageCall& call, const cli::BatchArguments& arguments,
                               const batch::AircraftGroup& group, const cli::ChosenAircraft& flown,
                               const batch::BatchOptions& all,
                               const std::optional<mechanical::MechanicalModel>& published) {
    auto options = all;
    auto flights = separate_aircraft(group, flown, options);
    cli::AircraftFolder made{group.selector, options.out.string(), {}, false};
    for (const auto number : group.flights) made.flights.push_back(flown.flights[number].flight);
    if (!call.json) cli::print(fmt::format("{}:\n", made.folder));
    try {
        made.has_model = finish_folder(call, arguments, flights, options, published).has_value();
    } catch (const NoResultError& error) {
        cli::warn(call, fmt::format("{}: no model: {}", made.folder, error.what()));
    }
    return made;
}

/// Makes a batch of each aircraft in the folder of all flights. Returns the exit code.
int finish_each(const cli::StageCall& call, const cli::BatchArguments& arguments, batch::BatchFlights flights,
                const batch::BatchOptions& options, const std::optional<mechanical::MechanicalModel>& published) {
    const auto flown = list_flights(call, flights, options).flown;
    remove_model(call, options.out);
    for (const auto& flight : flights)
        if (flight.selection.flights.empty()) add_diagnostics(call, flight);
    const auto aircraft = cli::certain_aircraft(call, flown.groups, flown.flights);
    settle_folders_of_each(call, options.out, aircraft, arguments.prune);
    if (flown.groups.empty()) throw InputError({}, "no flight can be fitted", "see the reasons above");
    std::vector<cli::AircraftFolder> made;
    made.reserve(aircraft.size());
    for (const auto& group : aircraft) made.push_back(finish_one(call, arguments, group, flown, options, published));
    if (call.json) cli::print_json(call, BatchOutput{nullptr, &made, &flights});
    const auto code = exit_code(call, totals_of(flights));
    const bool any_failed = std::ranges::any_of(made, [](const auto& one) { return !one.has_model; });
    return any_failed ? cli::no_answer : code;
}

int run_over_logs(const cli::StageCall& call, const cli::BatchArguments& arguments) {
    if (call.inputs.empty() && !arguments.files_from)
        throw UsageError("no log given: expected LOG, FOLDER or --files-from LIST");
    if (!call.output) throw UsageError("no folder for the results: expected -o DIR, such as -o flightwatt-out");
    cli::refuse_folder_of_logs(call, *call.output);
    const auto options = cli::batch_options(arguments, *call.output);
    const auto published = read_published(arguments.model);
    const cli::BatchFolder folder(options.out);
    cli::ProgressBar bar("logs");
    auto flights = read_logs(call, arguments, options, progress_of(call, bar));
    bar.hide();
    return arguments.flights.each ? finish_each(call, arguments, std::move(flights), options, published)
                                  : finish(call, arguments, std::move(flights), options, published);
}

}  // namespace

int flightwatt::stages::batch_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "batch", "LOG|FOLDER... -o OUT",
        R"(Parses and segments every log (.data, .bin, .ulg, .tlog, CSV; folders are searched to the bottom) into OUT/flights, several at a
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
    cli::BatchArguments arguments;
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
