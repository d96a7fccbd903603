// flightwatt fit: several flights to a mechanical power model and Table I.

#include "cli/stage.h"
#include "fit_error_output.h"
#include "fit_options.h"
#include "flight/flight_reader.h"
#include "flight/power_report.h"
#include "flight/segmentation.h"
#include "mechanical/measured_flight.h"
#include "table_one_output.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

MeasuredFlights read_log(const cli::StageCall& call, const std::string& file, std::size_t needed_samples) {
    auto series = read_flight(file, call.maybe<std::string>("aircraft"));
    const auto phases = segment(series);
    require_sortie(series, phases, file);
    const auto power = examine_power(series, phases);
    if (call.has("correct-idle-offset")) correct_idle_offset(series, power.idle);
    for (const auto& warning : series.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& warning : phases.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    auto measured = measure_flights(series, phases, needed_samples);
    const auto keep = call.maybe<std::vector<std::string>>("keep").value_or(std::vector<std::string>{});
    if (!power.absurdities.empty() && std::find(keep.begin(), keep.end(), series.flight) == keep.end()) {
        measured.flights.clear();
        measured.left_out.push_back({series.flight, std::nullopt, describe_absurdities(power.absurdities)});
    }
    for (const auto& left_out : measured.left_out) {
        cli::warn(call, to_string(left_out));
    }
    return measured;
}

/// What goes beyond a plain fit.
struct Wishes {
    bool auto_order = false;
    bool errors = false;
    TableIntervals intervals = TableIntervals::absent;
    std::optional<std::string> curves_file;
};

Wishes read_wishes(const cli::StageCall& call) {
    Wishes wishes;
    wishes.auto_order = !read_order(call, AutoOrder::accepted);
    wishes.curves_file = call.maybe<std::string>("curves");
    if (call.has("intervals")) wishes.intervals = TableIntervals::present;
    wishes.errors = call.has("errors") || call.has("intervals") || wishes.curves_file;
    return wishes;
}

ModelFitOptions read_options(const cli::StageCall& call) {
    auto options = read_fit_options(call, AutoOrder::accepted);
    options.name = call.maybe<std::string>("name").value_or(
        call.output ? std::filesystem::path(*call.output).stem().string() : "fitted");
    const auto name = call.get<std::string>("loss");
    const auto loss = loss_from(name);
    if (!loss) throw UsageError(fmt::format("--loss {}: expected none, huber or cauchy", name));
    options.phases.loss = *loss;
    if (const auto covariate = call.maybe<std::string>("level-covariate")) {
        options.level_covariate = covariate_from(*covariate);
        if (!options.level_covariate) {
            throw UsageError(
                fmt::format("--level-covariate {}: expected one of {}", *covariate, covariate_names()));
        }
    }
    return options;
}

std::vector<FlightSamples> read_flights(const cli::StageCall& call, int order) {
    std::vector<FlightSamples> flights;
    for (const auto& file : call.inputs) {
        auto measured = read_log(call, file, samples_needed(order));
        for (auto& flight : measured.flights) flights.push_back(std::move(flight.samples));
    }
    return flights;
}

/// Chooses each phase's order and says why.
PerPhase<OrderChoice> choose_orders(const cli::StageCall& call, std::span<const FlightSamples> flights,
                                    ModelFitOptions& options) {
    PerPhase<OrderChoice> choices;
    for (const auto phase : all_phases) {
        choices[phase] =
            choose_order(phase, samples_of_phase(flights, phase), options.phases, options.weights);
        options.orders[phase] = choices[phase].order;
        note_order(call, phase, choices[phase]);
    }
    return choices;
}

int fit(const cli::StageCall& call) {
    const auto wishes = read_wishes(call);
    auto options = read_options(call);
    const auto table_file = call.maybe<std::string>("table");
    if (table_file) table_text({{""}, {}}, *table_file);  // refuses a bad ending before the work
    std::optional<MechanicalModel> published;
    if (const auto file = call.maybe<std::string>("published")) published = read_mechanical_model(*file);
    const auto flights = read_flights(call, wishes.auto_order ? highest_tried_order : options.phases.order);
    std::optional<PerPhase<OrderChoice>> choices;
    if (wishes.auto_order) choices = choose_orders(call, flights, options);

    auto fitted = fit_model(flights, options);
    std::optional<PerPhase<PhaseErrorReport>> reports;
    if (wishes.errors) reports = add_errors(fitted);
    const bool robust = options.phases.loss != Loss::none;
    if (robust) note_down_weighted(call, fitted);

    const auto table = table_of(fitted.model, published, wishes.intervals);
    if (table_file) write_file_atomically(*table_file, table_text(table, *table_file));
    if (wishes.curves_file) write_file_atomically(*wishes.curves_file, curves_csv(fitted, *reports));
    cli::write_result(call, to_toml(fitted.model));
    warn_of_bounds(call, fitted.model);
    warn_of_given_frequencies(call, fitted.model);
    if (call.json) {
        auto json = to_json(fitted.model);
        if (reports) add_errors_json(json, fitted.model, *reports);
        if (robust) add_loss_json(json, fitted);
        for (const auto phase : all_phases) {
            if (choices) add_order_json(json, phase, (*choices)[phase]);
        }
        cli::print(json_text(json));
    } else if (call.output) {
        cli::print(to_text(table));
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    cli::StageDefinition stage;
    stage.name = "fit";
    stage.arguments = "FLIGHT.data|SERIES.csv...";
    stage.description =
        "Fits the mechanical power of take-off, cruise and landing: a third-order Fourier series a phase, "
        "one\n"
        "frequency for all flights, averaged over the flights with weights. The model goes to the standard "
        "output\n"
        "as TOML; with -o it goes to the file and Table I is shown.";
    add_fit_options(stage.options, AutoOrder::accepted);
    add_power_options(stage.options);
    stage.options.add_options()("name", po::value<std::string>()->value_name("NAME"), "the model's name")(
        "published", po::value<std::string>()->value_name("MODEL.toml"), "show Table I beside this model's")(
        "table", po::value<std::string>()->value_name("FILE"), "write Table I as .txt, .csv, .md or .tex")(
        "errors",
        "analyse the fit: standard errors, R2, condition, autocorrelation, frequency profile, spread "
        "between flights, into the model and the JSON")(
        "intervals", "Table I with half widths of 95 % intervals; implies --errors")(
        "curves", po::value<std::string>()->value_name("FILE.csv"),
        "write the curves with their band and the flights' envelope; implies --errors")(
        "level-covariate", po::value<std::string>()->value_name("NAME"),
        "let the cruise level follow what 'flightwatt validate --covariate all' found to foretell it: "
        "airspeed_m_per_s, height_m, wind_m_per_s ...; a mission then states it in [conditions]")(
        "loss", po::value<std::string>()->value_name("HOW")->default_value("none"),
        "none, huber or cauchy: how outliers count in the last refinement")(
        "aircraft", po::value<std::string>()->value_name("ID"), "the aircraft to read, where several flew");
    return cli::run_stage(argc, argv, stage, fit);
}
