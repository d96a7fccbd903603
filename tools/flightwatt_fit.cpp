// flightwatt fit: several flights to a mechanical power model and Table I.

#include "base/atomic_file.h"
#include "cli/output/fit_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/physical_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"
#include "stages.h"

#include <filesystem>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

struct FitStageArguments {
    cli::FitArguments model;
    cli::FlightArguments flights;
    cli::FlightFilter filter;
    std::optional<std::string> name;
    std::optional<std::string> table_file;
    std::optional<std::string> constants_file;
    std::optional<std::string> curves_file;
    double headwind_m_per_s = 0.0;
    bool with_errors = false;
    bool with_intervals = false;
};

/// Refuses a file whose ending names no form of tables, before the work.
void check_table_file(const std::optional<std::string>& file) {
    if (file) cli::table_text({{""}, {}}, *file);
}

/// Fits the flights of one aircraft, and writes and prints the result.
void fit_flights(const cli::StageCall& call, FitStageArguments arguments,
                 const std::vector<mechanical::MeasuredFlight>& measured,
                 const std::optional<mechanical::MechanicalModel>& published) {
    const auto& [options, kind, published_file] = arguments.model;
    const auto& [table_file, constants_file, curves_file] =
        std::tie(arguments.table_file, arguments.constants_file, arguments.curves_file);
    arguments.model.fit.name =
        arguments.name.value_or(call.output ? std::filesystem::path(*call.output).stem().string() : "fitted");
    const bool with_motion = kind == cli::ModelKind::physical;
    std::vector<mechanical::FlightSamples> flights;
    flights.reserve(measured.size());
    for (const auto& flight : measured) flights.push_back(flight.samples);
    auto fitted = fit_model(flights, options);
    flight::PerPhase<mechanical::ErrorAnalysis> analyses;
    if (arguments.with_errors || arguments.with_intervals || curves_file) analyses = mechanical::analyse_model(fitted);

    const auto table = cli::model_table(
        fitted.model, published,
        arguments.with_intervals ? mechanical::TableIntervals::present : mechanical::TableIntervals::absent);
    std::optional<mechanical::PhysicalFit> physical;
    if (with_motion) physical = cli::fit_motion(call, measured, fitted.model, arguments.headwind_m_per_s);
    if (kind != cli::ModelKind::fourier) cli::add_best_power(measured, options, fitted.model);
    if (table_file) write_file_atomically(*table_file, cli::table_text(table, *table_file));
    if (constants_file)
        write_file_atomically(*constants_file, cli::table_text(cli::constants_table(physical->model), *constants_file,
                                                               "Constants of the physical model, with 95 % intervals"));
    if (curves_file) write_file_atomically(*curves_file, curves_csv(fitted, analyses));
    cli::write_result(call, to_toml(fitted.model));
    warn_of_model(call, fitted.model);
    if (call.json) {
        cli::print_json(call, cli::FitOutput{&fitted.model, physical ? &*physical : nullptr, true});
    } else if (call.output) {
        const auto screen = screen_of(call);
        const cli::ScreenTable shown{fmt::format("{}: Table I of {} flight{}", fitted.model.name, flights.size(),
                                                 flights.size() == 1 ? "" : "s"),
                                     {}};
        const cli::ScreenTable means{"mean power of the phases", {}};
        cli::print(screen_text(cli::mean_power_table(fitted.model), screen, means) + "\n" +
                   screen_text(table, screen, shown) + (physical ? "\n" + cli::physical_text(*physical, screen) : ""));
    }
}

/// Fits each aircraft: -o FOLDER has FOLDER/AIRCRAFT/model.toml. Returns the exit code.
int fit_each(const cli::StageCall& call, const FitStageArguments& arguments,
             const std::vector<cli::FlightsOf<mechanical::MeasuredFlight>>& measured,
             const std::optional<mechanical::MechanicalModel>& published) {
    int code = cli::ok;
    for (const auto& [aircraft, flights] : measured) {
        const auto folder = std::filesystem::path(*call.output) / cli::file_name_of(aircraft);
        make_directories(folder);
        auto own = call;
        own.output = (folder / "model.toml").string();
        auto of_aircraft = arguments;
        of_aircraft.name = aircraft;
        try {
            fit_flights(own, std::move(of_aircraft), flights, published);
        } catch (const NoResultError& error) {
            cli::warn(call, fmt::format("{} is not written: {}", *own.output, error.what()));
            code = cli::no_answer;
        }
    }
    return code;
}

int fit(const cli::StageCall& call, FitStageArguments arguments) {
    if (arguments.model.published && !call.has("model-kind"))
        arguments.model.kind = cli::ModelKind::fourier;  // which is compared
    check_table_file(arguments.table_file);
    check_table_file(arguments.constants_file);
    for (const auto* option : {"constants", "headwind"})
        if (call.has(option) && arguments.model.kind != cli::ModelKind::physical)
            throw UsageError(fmt::format("--{} goes with --model-kind physical", option));
    if (arguments.flights.each && !call.output)
        throw UsageError("--each needs -o FOLDER, for the models FOLDER/AIRCRAFT/model.toml");
    const auto published = read_published(arguments.model);
    const auto measured = cli::measured_by_aircraft(
        cli::with_chosen_flights(call, arguments.filter, arguments.flights.load), arguments.flights);
    if (arguments.flights.each) return fit_each(call, arguments, measured, published);
    fit_flights(call, arguments, measured.front().flights, published);
    return cli::ok;
}

}  // namespace

int flightwatt::stages::fit_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "fit", "LOG|SERIES.csv|FOLDER...",
        R"(Fits the mechanical power of take-off, cruise and landing: a third-order Fourier series a phase, one
frequency for all flights, averaged over the flights with weights. A phase is predicted by its mean power
where the samples do not determine the curve, or it predicts flights left out of the fit worse; the model's
file states which and why. With --published the curves predict. The model goes to the standard output
as TOML; with -o it goes to the file and Table I is shown.)" +
            std::string(cli::several_flights_text)};
    stage.next = [](const auto& call) {
        return call.has("each")
                   ? "flightwatt new-mission --model {}/AIRCRAFT/model.toml --battery PACK.toml -o mission.toml"
                   : "flightwatt new-mission --model {} --battery PACK.toml -o mission.toml";
    };
    stage.json_schema = cli::document_schema<cli::FitOutput>;
    stage.examples = {"flightwatt fit my -o model.toml --table table1.tex",
                      "flightwatt fit my --since 2020-07-01 --model-kind physical -o model.toml"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    FitStageArguments arguments;
    auto& options = stage.options;
    cli::add_model_options(options, arguments.model);
    options.add("name", arguments.name, {.value = "NAME"}, "the model's name");
    options.add("table", arguments.table_file, cli::output_file("FILE"), "write Table I as .txt, .csv, .md or .tex");
    options.add("constants", arguments.constants_file, cli::output_file("FILE"),
                "write the constants of the physical model with their 95 % intervals as .txt, .csv, .md or .tex");
    options.add(
        "errors", arguments.with_errors,
        "analyse the fit: standard errors, R2, condition, autocorrelation, variability between flights, into the "
        "model and the JSON");
    options.add("intervals", arguments.with_intervals, "Table I with 95 % intervals; implies --errors");
    options.add("curves", arguments.curves_file, cli::output_file("FILE.csv"),
                "write the curves with their band and the flights' envelope; implies --errors");
    cli::add_each_option(options, arguments.flights,
                         "a model for each aircraft: FOLDER/AIRCRAFT/model.toml for -o FOLDER",
                         {"name", "table", "constants", "curves", "json"});
    constexpr double max_wind_m_per_s = 100.0;
    options.add("headwind", arguments.headwind_m_per_s,
                {.value = "M_PER_S", .min = -max_wind_m_per_s, .max = max_wind_m_per_s, .unit = "m/s"},
                "speed to fly of the physical model also in this headwind; below 0: tailwind");
    cli::add_filter_options(options, arguments.filter);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return fit(call, arguments); });
}
