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
        "time_s, phase, mechanical_w, compute_w, power_w, current_a, soc_percent, terminal_voltage_v. Powers "
        "are what\n"
        "the mission demands; current is the battery's, 0 once it is empty or below the mission's cut-off "
        "voltage.\n"
        "What ended the flight and what was left is told besides; --json: final_soc_percent, energy_wh "
        "(demanded),\n"
        "delivered_energy_wh, depleted_at_s, cut_off_at_s (null: never), feasible, keeps_reserve, utility.";
    stage.max_inputs = 1;
    stage.options.add_options()(
        "step", boost::program_options::value<double>()->default_value(1.0, "1")->value_name("S"),
        "seconds between rows; jumps of power have rows besides");
    return flightwatt::cli::run_stage(argc, argv, stage, simulate_mission);
}
