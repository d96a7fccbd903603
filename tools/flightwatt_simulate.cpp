// A mission file to its state of charge over time.

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/output/mission_output.h"
#include "cli/output/requirement.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/mission_file.h"
#include "mission/planned_mission_toml.h"
#include "mission/prepared_mission.h"
#include "stages.h"

#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

struct SimulateArguments {
    double step_s = 1.0;
    std::optional<std::string> schedule_file;
    cli::SamplingArguments sampling;
    std::optional<std::string> samples_file;
    cli::Requirement requirement;
};

/// The mission with the schedule that was flown, wherever it came from.
void write_schedule(const cli::StageCall& call, const std::optional<std::string>& file, const std::string& text,
                    const mission::PreparedMission& prepared, const mission::SimulatedFlight& flight) {
    if (!file) return;
    const auto folder = std::filesystem::absolute(*file).parent_path();
    const auto heading = fmt::format("# {}\n", one_line(describe(flight.simulation.summary)));
    const auto& setup = flight.setup ? *flight.setup : prepared.setup;
    const auto flown =
        planned_mission_toml(text, call.inputs.front(), setup.compute, flight.schedule, folder, layout_of(setup));
    write_file_atomically(*file, heading + flown.text);
    cli::warn_of_lost_comments(call, flown);
}

/// Draws flights if they were asked for.
void sample(const SimulateArguments& arguments, const mission::PreparedMission& prepared,
            const std::vector<mission::Disturbance>& disturbed_by, mission::MissionSummary& summary) {
    const auto& file = arguments.samples_file;
    const auto options = sampling_options(arguments.sampling, file.has_value());
    if (!options) return;
    if (file) require_known_probabilities(prepared.setup);
    if (arguments.requirement.probability && !has_uncertainty(prepared.setup)) return;
    summary.samples = sample_flights(prepared, disturbed_by, *options);
    if (file) write_file_atomically(*file, to_csv(summary.samples->bands));
}

int simulate_mission(const cli::StageCall& call, const SimulateArguments& arguments) {
    constexpr std::size_t rows = 24;
    const auto text = read_file(call.inputs.front());
    const auto mission = mission::parse_mission(text, call.inputs.front());
    const auto& stated = setup_of(mission);
    const bool chooses_lines = stated.survey && stated.survey->is_chosen;
    if (!chooses_lines) cli::warn_of_setup(call, stated);
    const bool draws = arguments.sampling.samples || arguments.sampling.disturbances || arguments.schedule_file;
    if (setup_of(mission).packs && !draws) {
        const auto all = mission::fly_packs(mission, {.output_s = arguments.step_s});
        if (!all.suffice && arguments.requirement.text) return report_missed(call, describe(all));
        print_packs(call, all, to_csv(all.curve),
                    {all.setup.name, {"time_s", "phase", "soc_percent", "power_w"}, rows});
        return check_requirement(call, arguments.requirement, {all.total});
    }
    const auto disturbed_by = read_disturbances(arguments.sampling, setup_of(mission));
    const auto prepared = prepare_mission(mission);
    mission::SimulationOptions steps;
    steps.output_s = arguments.step_s;
    auto flight = simulate_prepared(prepared, steps, disturbed_by);
    if (chooses_lines) cli::warn_of_setup(call, flight.setup ? *flight.setup : prepared.setup);
    auto& summary = flight.simulation.summary;
    if (summary.undeliverable && !arguments.requirement.text) throw NoResultError(describe(summary));
    if (summary.undeliverable) return check_requirement(call, arguments.requirement, {summary});
    sample(arguments, prepared, disturbed_by, summary);
    write_schedule(call, arguments.schedule_file, text, prepared, flight);
    write_csv_result(call, to_csv(flight.simulation.curve),
                     {summary.mission, {"time_s", "phase", "soc_percent", "power_w"}, rows});
    if (call.json) {
        cli::print_json(call, summary);
    } else {
        cli::note(call, describe(summary));
        cli::note_power_model(call, setup_of(mission));
        if (summary.samples)
            cli::note(call, call.notes ? describe(*summary.samples) : describe_briefly(*summary.samples));
    }
    return check_requirement(call, arguments.requirement, {summary});
}

}  // namespace

int flightwatt::stages::simulate_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "simulate", "MISSION.toml",
        R"(Computes the power that a mission demands and the battery's state of charge over time, as CSV:
time_s, phase, mechanical_w, compute_w, power_w, current_a, soc_percent, terminal_voltage_v. Powers are what
the mission demands; current is the battery's, 0 once it is empty or below the mission's cut-off voltage.
The cause of the end and the remaining charge are printed as well; --json: final_soc_percent, energy_wh (demanded),
delivered_energy_wh, depleted_at_s, cut_off_at_s (null: never), feasible, keeps_reserve, utility.
With [packs], the flights follow each other, with the time on the ground between them.
A mission with [policy] kind = "adaptive" is replanned in flight. --samples draws flights and reports
their final state of charge; the CSV stays that of the mission as it is stated.)"};
    stage.max_inputs = 1;
    stage.next = [](const auto&) { return "flightwatt report OUT {in} -o report.html"; };
    stage.json_schema = cli::document_schema<mission::MissionSummary, mission::PackFlights>;
    stage.shows_table = true;
    stage.examples = {"flightwatt simulate mission.toml -o soc.csv",
                      "flightwatt simulate mission.toml --samples 2000 --json",
                      "flightwatt simulate mission.toml --require reserve=0.95"};
    stage.uses_threads = true;
    SimulateArguments arguments;
    auto& options = stage.options;
    options.add("step", arguments.step_s, {.value = "S", .min = 0.0, .above_min = true, .unit = "s"},
                "seconds between rows; jumps of power have additional rows");
    options.add("schedule-out", arguments.schedule_file, cli::output_file("FILE"),
                "write the mission with the schedule that was flown to FILE");
    add_sampling_options(options, arguments.sampling);
    add_require_option(options, arguments.requirement, arguments.sampling);
    options.add("samples-csv", arguments.samples_file,
                {.value = "FILE", .file = cli::FileRole::output, .needs = {"samples"}},
                "write the state of charge over time that 5, 50 and 95 % of the drawn flights are below");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return simulate_mission(call, arguments); });
}
