// Several mission files to a table, ranked by what they leave in the battery.

#include "cli/stage.h"
#include "mission/comparison.h"
#include "mission/plan.h"
#include "mission_json.h"

#include <fmt/format.h>

namespace {

std::string ranking_json(const std::vector<flightwatt::MissionSummary>& ranking) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& summary : ranking) list.push_back(to_json(summary));
    return flightwatt::json_text(list);
}

/// Runs a mission; one that is yet to be planned is planned first.
flightwatt::MissionSummary summary_of(const flightwatt::Mission& mission) {
    using namespace flightwatt;
    if (!mission.plan) return simulate(mission).summary;
    return labelled_summary(plan_mission(mission));
}

int compare_missions(const flightwatt::cli::StageCall& call) {
    using namespace flightwatt;
    std::vector<Mission> missions;  // all read before the first is run: a bad file leaves no half answer
    missions.reserve(call.inputs.size());
    for (const auto& file : call.inputs) missions.push_back(read_mission(file, {true, std::nullopt}));
    std::vector<MissionSummary> summaries;
    summaries.reserve(missions.size());
    for (const auto& mission : missions) summaries.push_back(summary_of(mission));
    const auto ranking = ranked(std::move(summaries));
    const auto table = comparison_table(ranking);
    cli::write_result(call, call.has("markdown") ? to_markdown(table) : to_text(table));
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
