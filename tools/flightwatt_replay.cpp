// flightwatt replay: missions' schedules on the power that flights measured.

#include "cli/output/fit_output.h"
#include "cli/output/flight_options.h"
#include "cli/output/mission_output.h"
#include "cli/output/replay_output.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "mission/mission_file.h"
#include "mission/replay.h"
#include "stages.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;

struct ReplayArguments {
    std::vector<std::string> missions;
    std::optional<std::string> model;
    mechanical::ModelFitOptions fit;
    cli::FlightArguments flights;
};

std::vector<mission::MissionVariant> read_missions(const cli::StageCall& call, const std::vector<std::string>& files) {
    if (files.empty()) throw UsageError("no mission given: --mission FILE, as often as there are missions");
    std::vector<mission::MissionVariant> missions;
    std::set<std::string> names;
    for (const auto& file : files) {
        missions.push_back(mission::read_mission(file, {true, std::nullopt}));
        const auto& setup = setup_of(missions.back());
        cli::warn_of_setup(call, setup);
        if (!names.insert(setup.name).second)
            throw UsageError(fmt::format("two missions are called '{}': give them names that differ", setup.name));
    }
    return missions;
}

int replay(const cli::StageCall& call, const ReplayArguments& arguments) {
    mission::ReplayOptions options;
    options.fit = arguments.fit;
    const auto missions = read_missions(call, arguments.missions);
    if (arguments.model) options.model = mechanical::read_predicting_model(*arguments.model);
    const auto flights = cli::measured_flights(call, arguments.flights);
    cli::ProgressBar replaying("replays");
    options.progress = replaying.callback();
    auto replays = replay_flights(missions, flights, options);
    replaying.hide();
    for (const auto& left : replays.not_replayed)
        cli::warn(call, fmt::format("{}: {} is not replayed on it: {}", left.flight, left.mission, left.reason));
    for (const auto& flight : *call.skipped)
        for (const auto& mission : missions)
            replays.not_replayed.push_back({cli::flight_of_file(flight.file), setup_of(mission).name, flight.reason});
    for (const auto& replay : replays.replays)
        for (const auto& text : replay.notes)
            cli::note(call, fmt::format("{}, {}: {}", replay.flight, replay.mission, text));
    if (replays.replays.empty()) throw NoResultError("no mission could be flown on any flight");
    if (call.output) cli::write_result(call, cli::replay_csv(replays.replays));
    if (call.json)
        cli::print_json(call, replays);
    else
        cli::print(cli::replay_text(replays.replays, screen_of(call)));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::replay_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "replay", "LOG|SERIES.csv|FOLDER... --mission MISSION.toml",
        R"(Evaluates schedules on measured flights: the measured power of each flight, phase by phase, and the
computing power of a schedule together deplete the mission's battery. Before a flight, only a model fitted to
the other flights is known. Schedules:
  given                by the mission file; of a mission to be planned instead all of these:
  invariant            one configuration, the best that keeps the reserve by the model
  phased               one a phase
  planned              before the flight, by the model
  planned_with_margin  the same with a margin, to keep the reserve with the policy's probability
  replanned            in flight, from the current charge and the measured power ([policy], or its defaults)
  hindsight            by the power and durations that were measured: no schedule does better
Where no plan keeps the reserve, the schedule of minimum energy is flown, and the table marks it. Regret is
the utility of hindsight minus that of the schedule; schedules that do not keep the reserve have none. At the
end replanning in flight is compared with planning beforehand. -o writes the table of schedules as CSV.)" +
            std::string(cli::several_flights_text)};
    stage.json_schema = cli::document_schema<mission::Replays>;
    stage.examples = {"flightwatt replay my --mission mission.toml",
                      "flightwatt replay my --mission a.toml --mission b.toml -o replays.csv"};
    stage.reads_logs = stage.uses_threads = stage.shows_table = true;
    stage.output_help = "write the table of schedules to FILE, as CSV";
    ReplayArguments arguments;
    auto& options = stage.options;
    options.add("mission", arguments.missions, cli::input_file("FILE"),
                "a mission whose schedules are replayed; may be given several times");
    options.add("model", arguments.model, cli::input_file("MODEL.toml"),
                "plan each flight with this model, instead of one fitted to the other flights");
    cli::add_fit_options(options, arguments.fit);
    cli::add_flight_options(options, arguments.flights);
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return replay(call, arguments); });
}
