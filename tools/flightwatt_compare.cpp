// Several mission files to a table, ranked by what they leave in the battery.

#include "cli/stage.h"
#include "mission/comparison.h"
#include "mission_json.h"

namespace {

std::string ranking_json(const std::vector<flightwatt::MissionSummary>& ranking) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& summary : ranking) list.push_back(to_json(summary));
    return flightwatt::json_text(list);
}

int compare_missions(const flightwatt::cli::StageCall& call) {
    using namespace flightwatt;
    std::vector<Mission> missions;  // all read before the first is run: a bad file leaves no half answer
    missions.reserve(call.inputs.size());
    for (const auto& file : call.inputs) missions.push_back(read_mission(file));
    std::vector<MissionSummary> summaries;
    summaries.reserve(missions.size());
    for (const auto& mission : missions) summaries.push_back(simulate(mission).summary);
    const auto ranking = ranked(std::move(summaries));
    const auto table = comparison_table(ranking);
    cli::write_result(call, call.has("markdown") ? to_markdown(table) : to_text(table));
    if (call.json) cli::print(ranking_json(ranking));
    int code = cli::ok;
    for (const auto& summary : ranking) {
        if (!summary.undeliverable) continue;
        cli::warn(call, describe(summary));
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
        "lasts longer comes first. --json lists the summaries in that order.";
    stage.options.add_options()("markdown", "write the table as Markdown");
    return flightwatt::cli::run_stage(argc, argv, stage, compare_missions);
}
