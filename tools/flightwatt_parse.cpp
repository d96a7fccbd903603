// flightwatt parse: a Paparazzi log to the series CSV of its power samples.

#include "cli/output/json_text.h"
#include "cli/stage.h"
#include "flight/flight_reader.h"
#include "flight/phase_statistics.h"
#include "flight/series_file.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;

nlohmann::ordered_json summary(const flight::FlightSeries& series) {
    return {{"flight", series.flight},
            {"aircraft_id", series.aircraft_id},
            {"aircraft_name", series.aircraft_name},
            {"power_source", series.power_source},
            {"samples", series.time_s.size()},
            {"start_s", series.time_s.front()},
            {"end_s", series.time_s.back()},
            {"usual_interval_s", usual_interval_s(series)},
            {"sources", series.sources},
            {"warnings", series.warnings}};
}

int parse(const cli::StageCall& call) {
    const auto series = flight::read_flight(call.inputs.front(), call.maybe<std::string>("aircraft"));
    cli::write_result(call, to_csv(series));
    for (const auto& warning : series.warnings)
        cli::warn(call, fmt::format("{}: {}", call.inputs.front(), warning));
    if (call.json) {
        cli::print(cli::json_text(summary(series)));
        return cli::ok;
    }
    cli::note(call,
              fmt::format("{}: aircraft {} {}, {} samples from {:.1f} to {:.1f} s, usually {:.2f} s apart",
                          series.flight, series.aircraft_id, series.aircraft_name, series.time_s.size(),
                          series.time_s.front(), series.time_s.back(), flight::usual_interval_s(series)));
    for (const auto& [channel, source] : series.sources) {
        cli::note(call, fmt::format("  {:<20} from {}", channel, source));
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::StageDefinition stage;
    stage.name = "parse";
    stage.arguments = "FLIGHT.data";
    stage.description =
        "Reads a Paparazzi .data log (also .gz, .bz2, .xz, .zst) with the .log beside it and writes its "
        "power\n"
        "samples with altitude, throttle, voltage, current, charge, energy and position as CSV.";
    stage.max_inputs = 1;
    stage.options.add_options()("aircraft", boost::program_options::value<std::string>()->value_name("ID"),
                                "the aircraft to read, where several flew");
    return cli::run_stage(argc, argv, stage, parse);
}
