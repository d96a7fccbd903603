// A mission file to its state of charge over time.

#include "base/error.h"
#include "cli/stage.h"
#include "mission/simulation.h"
#include "mission_json.h"

namespace {

int simulate_mission(const flightwatt::cli::StageCall& call) {
    using namespace flightwatt;
    SimulationSteps steps;
    steps.output_s = call.get<double>("step");
    const auto result = simulate(read_mission(call.inputs.front()), steps);
    if (result.summary.undeliverable) throw NoAnswerError(describe(result.summary));
    cli::write_result(call, to_csv(result.curve));
    if (call.json) {
        cli::print(json_text(to_json(result.summary)));
    } else {
        cli::note(call, describe(result.summary));
    }
    return cli::ok;
}

}  // namespace

int main(int argc, char** argv) {
    flightwatt::cli::StageDefinition stage;
    stage.name = "simulate";
    stage.arguments = "MISSION.toml";
    stage.description =
        "Computes the power that a mission demands and the battery's state of charge over time, as CSV:\n"
        "time_s, phase, mechanical_w, compute_w, power_w, current_a, soc_percent, terminal_voltage_v.";
    stage.max_inputs = 1;
    stage.options.add_options()(
        "step", boost::program_options::value<double>()->default_value(1.0, "1")->value_name("S"),
        "seconds between rows; jumps of power have rows besides");
    return flightwatt::cli::run_stage(argc, argv, stage, simulate_mission);
}
