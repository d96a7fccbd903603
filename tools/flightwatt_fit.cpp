// flightwatt fit: several flights to a mechanical power model and Table I.

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/output/fit_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/physical_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"
#include "stages.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

mechanical::ModelFitOptions read_options(const cli::StageCall& call) {
    auto options = read_fit_options(call);
    options.name = call.get_optional<std::string>("name").value_or(
        call.output ? std::filesystem::path(*call.output).stem().string() : "fitted");
    return options;
}

int fit(const cli::StageCall& call) {
    const auto kind = cli::model_kind(call);
    const bool with_motion = kind == cli::ModelKind::physical;
    const auto options = read_options(call);
    const auto table_file = call.get_optional<std::string>("table");
    if (table_file) cli::table_text({{""}, {}}, *table_file);  // refuses a bad ending before the work
    const auto constants_file = call.get_optional<std::string>("constants");
    if (constants_file && !with_motion) throw UsageError("--constants goes with --model physical");
    if (constants_file) cli::table_text({{""}, {}}, *constants_file);
    const auto curves_file = call.get_optional<std::string>("curves");
    const auto published = cli::read_published(call);
    const auto reading = cli::read_flight_options(call);
    const auto measured = cli::measured_flights(cli::with_chosen_flights(call, reading), reading,
                                                mechanical::min_samples(options.phases.order));
    std::vector<mechanical::FlightSamples> flights;
    flights.reserve(measured.size());
    for (const auto& flight : measured) flights.push_back(flight.samples);
    auto fitted = fit_model(flights, options);
    flight::PerPhase<mechanical::ErrorAnalysis> analyses;
    const bool with_errors = call.has("errors") || call.has("intervals") || curves_file;
    if (with_errors) analyses = mechanical::analyse_model(fitted);

    const auto table =
        cli::table_of(fitted.model, published,
                      call.has("intervals") ? mechanical::TableIntervals::present : mechanical::TableIntervals::absent);
    std::optional<mechanical::PhysicalFit> physical;
    if (with_motion) physical = cli::fit_motion(call, measured, fitted.model);
    if (kind == cli::ModelKind::best) cli::add_best_power(measured, options, fitted.model);
    if (table_file) write_file_atomically(*table_file, cli::table_text(table, *table_file));
    if (constants_file)
        write_file_atomically(*constants_file, cli::table_text(cli::constants_table(physical->model), *constants_file));
    if (curves_file) write_file_atomically(*curves_file, curves_csv(fitted, analyses));
    cli::write_result(call, to_toml(fitted.model));
    warn_of_model(call, fitted.model);
    if (call.json) {
        auto json = cli::to_json(fitted.model);
        cli::add_errors_json(json, fitted.model);
        if (physical) json["physical"] = cli::physical_json(*physical);
        cli::print(cli::json_text(json));
    } else if (call.output) {
        const auto screen = screen_of(call);
        const cli::ScreenTable shown{fmt::format("{}: Table I of {} flights", fitted.model.name, flights.size()), {}};
        const cli::ScreenTable means{"mean power of the phases", {}};
        cli::print(screen_text(cli::mean_power_table(fitted.model), screen, means) + "\n" +
                   screen_text(table, screen, shown) + (physical ? "\n" + cli::physical_text(*physical, screen) : ""));
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::fit_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "fit", "FLIGHT.data|SERIES.csv|FOLDER...",
        R"(Fits the mechanical power of take-off, cruise and landing: a third-order Fourier series a phase, one
frequency for all flights, averaged over the flights with weights. The model goes to the standard output
as TOML; with -o it goes to the file and Table I is shown.)" +
            std::string(cli::several_flights_text)};
    stage.shows_table = true;
    cli::add_fit_options(stage.options);
    cli::add_model_option(stage.options, cli::ModelKind::fourier);
    auto add = stage.options.add_options();
    add("name", cli::value("NAME"), "the model's name");
    add("published", cli::input_file("MODEL.toml"), "show Table I beside this model's");
    add("table", cli::output_file("FILE"), "write Table I as .txt, .csv, .md or .tex");
    add("constants", cli::output_file("FILE"),
        "write the constants of the physical model with their 95 % intervals as .txt, .csv, .md or .tex");
    add("errors",
        "analyse the fit: standard errors, R2, condition, autocorrelation, spread between flights, into the "
        "model and the JSON");
    add("intervals", "Table I with 95 % intervals; implies --errors");
    add("curves", cli::output_file("FILE.csv"),
        "write the curves with their band and the flights' envelope; implies --errors");
    cli::add_choice_options(stage.options);
    cli::add_mix_option(stage.options);
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, fit);
}
