// flightwatt segment: take-off, cruise and landing of every sortie in a log.

#include "cli/output/json_text.h"
#include "cli/output/segment_explanation.h"
#include "cli/output/segment_json.h"
#include "cli/output/terminal_pictures.h"
#include "cli/stage.h"
#include "flight/flight_reader.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;

int segment_flight(const cli::StageCall& call) {
    const auto& file = call.inputs.front();
    const auto series = flight::read_flight(file, call.maybe<std::string>("aircraft"));
    flight::SegmentationOptions options;
    options.cruise_fraction = call.get<double>("cruise-fraction");
    options.ground_fraction = call.get<double>("ground-fraction");
    options.flight_height_m = call.get<double>("flight-height");
    options.rest_s = call.get<double>("rest");
    options.hold_s = call.get<double>("hold");
    options.idle_throttle_percent = call.get<double>("idle-throttle");
    const auto phases = segment(series, options);
    flight::require_sortie(series, phases, file);
    for (const auto& warning : series.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& warning : phases.warnings) cli::warn(call, fmt::format("{}: {}", file, warning));
    for (const auto& other : phases.others) {
        cli::note(call, fmt::format("{}: no flight from {:.0f} to {:.0f} s: {}", file, other.start_s,
                                    other.end_s, other.what));
    }
    const auto power = flight::examine_power(series, phases);
    for (const auto& absurdity : power.absurdities) {
        cli::warn(call, fmt::format("{}: absurd power record: {}", file, absurdity));
    }
    const bool explain = call.has("explain");
    if (!explain || call.output) cli::write_result(call, flight::phases_csv(series, phases));
    if (call.json) {
        cli::print(cli::json_text(cli::to_json(series, phases, power)));
    } else if (explain) {
        cli::print(cli::explanation(series, phases, power));
    }
    if (const auto plot = terminal_plot(call, "altitude [m] over time")) {
        cli::print(altitude_profile(*plot, series, phases));
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    const flight::SegmentationOptions defaults;
    cli::StageDefinition stage;
    stage.name = "segment";
    stage.arguments = "FLIGHT.data|SERIES.csv";
    stage.description =
        "Finds every sortie in a log by altitude and throttle and writes its phases as CSV: take-off from\n"
        "lift-off until the height held is reached, cruise, landing from where that height is left until\n"
        "touchdown. TAKEOFF messages, mode and block stand beside each edge as witnesses; they decide "
        "nothing.";
    stage.max_inputs = 1;
    stage.options.add_options()("explain",
                                "show the reasons for each edge, and what the power record is worth")(
        "rest", po::value<double>()->value_name("S")->default_value(defaults.rest_s, "10"),
        "an aircraft that keeps its height so long [s] with its motor idling is at rest")(
        "hold", po::value<double>()->value_name("S")->default_value(defaults.hold_s, "30"),
        "a height that grows by less than a tenth of the flight's in this time [s] is held")(
        "idle-throttle",
        po::value<double>()->value_name("P")->default_value(defaults.idle_throttle_percent, "5"),
        "up to this throttle [%] the motor idles")("aircraft", po::value<std::string>()->value_name("ID"),
                                                   "the aircraft to read, where several flew")(
        "cruise-fraction",
        po::value<double>()->value_name("X")->default_value(defaults.cruise_fraction, "0.9"),
        "take-off ends and landing begins at this fraction of the height held")(
        "ground-fraction",
        po::value<double>()->value_name("X")->default_value(defaults.ground_fraction, "0.025"),
        "below this fraction of the flight's height it is on the ground")(
        "flight-height", po::value<double>()->value_name("M")->default_value(defaults.flight_height_m, "10"),
        "what stays below this height [m] is no flight");
    return cli::run_stage(argc, argv, stage, segment_flight);
}
