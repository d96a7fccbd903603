// flightwatt fit: several flights to a mechanical power model and Table I.

#include "cli/stage.h"
#include "fit_options.h"
#include "flight/flight_reader.h"
#include "flight/power_report.h"
#include "flight/segmentation.h"
#include "mechanical/flight_samples.h"
#include "table_one_output.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

FlightSelection read_selection(const cli::StageCall& call, const std::string& file,
                               std::size_t needed_samples) {
    auto series = read_flight(file, call.maybe<std::string>("aircraft"));
    const auto phases = segment(series);
    require_sortie(series, phases, file);
    const auto power = examine_power(series, phases);
    if (call.has("correct-idle-offset")) correct_idle_offset(series, power.idle);
    for (const auto& warning : series.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& warning : phases.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    auto selection = select_samples(series, phases, needed_samples);
    const auto keep = call.maybe<std::vector<std::string>>("keep").value_or(std::vector<std::string>{});
    if (!power.absurdities.empty() && std::find(keep.begin(), keep.end(), series.flight) == keep.end()) {
        leave_out_all(selection, series.flight, describe_absurdities(power.absurdities));
    }
    for (const auto& left_out : selection.left_out) {
        cli::warn(call, to_string(left_out));
    }
    return selection;
}

int fit(const cli::StageCall& call) {
    auto options = read_fit_options(call);
    options.name = call.maybe<std::string>("name").value_or(
        call.output ? std::filesystem::path(*call.output).stem().string() : "fitted");
    const auto table_file = call.maybe<std::string>("table");
    if (table_file) table_text({}, *table_file);  // refuses a bad ending before the work
    std::optional<MechanicalModel> published;
    if (const auto file = call.maybe<std::string>("published")) published = read_mechanical_model(*file);
    std::vector<FlightSamples> flights;
    for (const auto& file : call.inputs) {
        auto selection = read_selection(call, file, samples_needed(options.phases.order));
        for (auto& flight : selection.flights) flights.push_back(std::move(flight));
    }
    const auto model = fit_mechanical_model(flights, options);
    const auto table = table_of(model, published);
    if (table_file) write_file_atomically(*table_file, table_text(table, *table_file));
    cli::write_result(call, to_toml(model));
    warn_of_bounds(call, model);
    if (call.json)
        cli::print(json_text(to_json(model)));
    else if (call.output)
        cli::print(to_text(table));
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
    add_fit_options(stage.options);
    add_power_options(stage.options);
    stage.options.add_options()("name", po::value<std::string>()->value_name("NAME"), "the model's name")(
        "published", po::value<std::string>()->value_name("MODEL.toml"), "show Table I beside this model's")(
        "table", po::value<std::string>()->value_name("FILE"), "write Table I as .txt, .csv or .md")(
        "aircraft", po::value<std::string>()->value_name("ID"), "the aircraft to read, where several flew");
    return cli::run_stage(argc, argv, stage, fit);
}
