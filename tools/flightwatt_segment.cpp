// flightwatt segment: take-off, cruise and landing of every sortie in a log.

#include "cli/output/flight_options.h"
#include "cli/output/json_text.h"
#include "cli/output/segment_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "flight/phases_file.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;

int segment_flight(const cli::StageCall& call) {
    const auto& file = call.inputs.front();
    auto options = cli::read_flight_options(call);
    options.power_required = false;
    const auto loaded = cli::load_flight(call, file, options);
    const auto& series = loaded.series;
    const auto& phases = loaded.phases;
    const auto& power = loaded.power;
    for (const auto& other : phases.ground_events) {
        cli::note(call, fmt::format("{}: no flight from {:.0f} to {:.0f} s: {}", file, other.start_s, other.end_s,
                                    other.what));
    }
    for (const auto& fault : power.power_faults) {
        cli::warn(call, fmt::format("{}: power fault: {}", file, fault));
    }
    const bool explain = call.has("explain");
    if (!explain || call.output) {
        write_csv_result(call, flight::phases_csv(series, phases),
                         {cli::describe_flight(series, phases),
                          {"sortie", "phase", "start_s", "end_s", "duration_s", "mean_power_w", "energy_wh", "samples",
                           "gaps", "complete", "start_altitude_m", "end_altitude_m"}});
    }
    if (call.json) {
        cli::print(cli::json_text(cli::to_json(series, phases, power, loaded.warnings)));
    } else if (explain) {
        cli::print(cli::explanation(series, phases, power, screen_of(call)));
    }
    if (const auto plot = terminal_plot(call, "altitude [m] over time")) {
        cli::print(altitude_profile(*plot, series, phases));
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::StageDefinition stage{
        "segment", "FLIGHT.data|SERIES.csv",
        R"(Finds every sortie in a log by altitude and throttle and writes its phases as CSV: take-off from
lift-off until the height held is reached, cruise, landing from where that height is left until
touchdown. TAKEOFF messages, mode and block stand beside each edge as witnesses; they decide nothing.
A log without measured power is segmented too; its columns of power are then empty.)"};
    stage.max_inputs = 1;
    stage.shows_table = true;
    stage.options.add_options()("explain", "show the reasons for each edge, and how good the power record is");
    cli::add_flight_options(stage.options);
    return cli::run_stage(argc, argv, stage, segment_flight);
}
