// Several mission files to a table, ranked by what they leave in the battery.

#include "cli/stage.h"
#include "mission/comparison.h"
#include "mission/plan.h"
#include "mission_json.h"
#include "terminal_pictures.h"

#include <algorithm>

#include <fmt/format.h>

namespace {

std::string ranking_json(const std::vector<flightwatt::MissionSummary>& ranking) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& summary : ranking) list.push_back(to_json(summary));
    return flightwatt::json_text(list);
}

/// Runs a mission; one that is yet to be planned is planned first.
flightwatt::Simulation simulation_of(const flightwatt::Mission& mission) {
    using namespace flightwatt;
    if (!mission.plan) return simulate(mission);
    const auto planned = plan_mission(mission);
    auto simulation = simulate(planned.flown);
    simulation.summary = labelled_summary(planned);
    return simulation;
}

/// The curves under their ranks, as a picture; empty where the terminal shows none.
std::string soc_picture(const flightwatt::cli::StageCall& call,
                        const std::vector<flightwatt::Simulation>& simulations,
                        const std::vector<flightwatt::MissionSummary>& ranking) {
    using namespace flightwatt;
    const auto plot = terminal_plot(call, "state of charge [%] over time, by rank");
    if (!plot || call.has("markdown")) return "";
    std::vector<TerminalLine> lines;
    for (const auto& simulation : simulations) {
        const auto place = std::find_if(ranking.begin(), ranking.end(), [&](const MissionSummary& summary) {
            return summary.mission == simulation.summary.mission &&
                   summary.final_soc_percent == simulation.summary.final_soc_percent;
        });
        const auto rank = static_cast<std::size_t>(place - ranking.begin()) + 1;
        if (!simulation.curve.rows.empty()) lines.push_back(soc_line(simulation.curve, rank));
    }
    return draw(*plot, lines);
}

int compare_missions(const flightwatt::cli::StageCall& call) {
    using namespace flightwatt;
    std::vector<Mission> missions;  // all read before the first is run: a bad file leaves no half answer
    missions.reserve(call.inputs.size());
    for (const auto& file : call.inputs) missions.push_back(read_mission(file, {true, std::nullopt}));
    std::vector<Simulation> simulations;
    std::vector<MissionSummary> summaries;
    for (const auto& mission : missions) {
        simulations.push_back(simulation_of(mission));
        summaries.push_back(simulations.back().summary);
    }
    const auto ranking = ranked(std::move(summaries));
    const auto table = comparison_table(ranking);
    cli::write_result(call, call.has("markdown") ? to_markdown(table) : to_text(table));
    cli::print(soc_picture(call, simulations, ranking));
    if (call.json) cli::print(ranking_json(ranking));
    int code = cli::ok;
    for (const auto& summary : ranking) {
        const bool without_plan = !summary.schedule.empty() && !summary.feasible;
        if (!summary.undeliverable && !without_plan) continue;
        cli::warn(call,
                  summary.undeliverable
                      ? describe(summary)
                      : fmt::format("{}: {}; shown is what drains least, and `flightwatt plan` says what is "
                                    "missing",
                                    summary.mission, summary.schedule));
        code = cli::no_answer;
    }
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    flightwatt::cli::StageDefinition stage;
    stage.name = "compare";
    stage.arguments = "MISSION.toml...";
    stage.description =
        "Runs several missions and ranks them by final state of charge; of those that run empty, the one "
        "that\n"
        "lasts longer comes first. A mission without a schedule is planned first. --json lists the summaries "
        "in\n"
        "that order.";
    stage.options.add_options()("markdown", "write the table as Markdown");
    return flightwatt::cli::run_stage(argc, argv, stage, compare_missions);
}
