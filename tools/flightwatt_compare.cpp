// Several mission files to a table, ranked by what they leave in the battery.

#include "cli/output/mission_output.h"
#include "cli/output/requirement.h"
#include "cli/output/stage_options.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/mission_file.h"
#include "mission/mission_summary.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "stages.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// Runs a mission; one that is yet to be planned is planned first.
mission::MissionSummary simulated_summary(const mission::MissionVariant& mission,
                                          const cli::SamplingArguments& arguments) {
    const auto& setup = setup_of(mission);
    const auto disturbances = read_disturbances(arguments, setup);
    const auto sampling = sampling_options(arguments, false);
    const auto prepared = prepare_mission(mission);
    auto summary = simulate_prepared(prepared, {}, disturbances).simulation.summary;
    if (sampling && has_uncertainty(setup)) summary.samples = sample_flights(prepared, disturbances, *sampling);
    return summary;
}

enum class Form { text, markdown, csv };

/// By the ending of the result's file.
Form form_of(const cli::StageCall& call) {
    const auto ending = std::filesystem::path(call.output.value_or("")).extension();
    return ending == ".md" ? Form::markdown : ending == ".csv" ? Form::csv : Form::text;
}

std::string ranking_text(const cli::StageCall& call, const std::vector<mission::MissionSummary>& ranking, Form form) {
    const auto missions = cli::ranked_missions(ranking);
    if (form == Form::csv) return csv_of(missions);
    const auto table = table_of(missions);
    if (form == Form::markdown) return to_markdown(table);
    const auto screen = call.output ? cli::Screen() : screen_of(call);
    const auto count = ranking.size();
    return screen_text(table, screen,
                       {fmt::format("{} mission{}, the one with most charge left first", count, count == 1 ? "" : "s"),
                        {"rank", "mission", "final state of charge [%]", "probability below reserve", "utility",
                         "energy [Wh]", "duration [s]", "empty at [s]", "cut off at [s]"}});
}

/// Notes and warnings beyond the table.
int explain(const cli::StageCall& call, const std::vector<mission::MissionSummary>& ranking, bool sampled) {
    int code = cli::ok;
    for (const auto& summary : ranking) {
        if (sampled && !summary.samples) {
            cli::note(call, fmt::format("{}: no flights drawn: neither its models nor [uncertainty] state how "
                                        "they differ",
                                        summary.mission));
        }
        if (summary.samples && !call.json)
            cli::note(call, call.notes ? describe(*summary.samples) : describe_briefly(*summary.samples));
        if (summary.by_flights && !call.json)
            cli::note(call, fmt::format("{}: {}", summary.mission, describe(*summary.by_flights)));
        const bool lacks_plan = summary.schedule == mission::ScheduleOrigin::infeasible;
        if (!summary.undeliverable && !lacks_plan) continue;
        cli::warn(call, summary.undeliverable
                            ? describe(summary)
                            : fmt::format("{}: {}; the schedule of minimum energy is shown, and `flightwatt plan` "
                                          "reports the shortfall",
                                          summary.mission, to_string(summary.schedule)));
        code = cli::no_answer;
    }
    return code;
}

int compare_missions(const cli::StageCall& call, const cli::SamplingArguments& arguments,
                     const cli::Requirement& requirement) {
    const bool is_sampled = arguments.samples.has_value();
    const auto form = form_of(call);
    // All are read before the first is run: a bad file leaves no half answer.
    std::vector<mission::MissionVariant> missions;
    missions.reserve(call.inputs.size());
    cli::MissionNames names;
    for (const auto& file : call.inputs)
        missions.push_back(names.made_unique(call, mission::read_mission(file, {true, std::nullopt})));
    for (const auto& mission : missions) cli::warn_of_setup(call, setup_of(mission));
    std::vector<mission::MissionSummary> summaries;
    summaries.reserve(missions.size());
    for (const auto& mission : missions) summaries.push_back(simulated_summary(mission, arguments));
    if (is_sampled && !requirement.probability &&
        std::ranges::none_of(missions, [](const auto& mission) { return has_uncertainty(setup_of(mission)); })) {
        require_uncertainty(setup_of(missions.front()));  // throws, with the reason
    }
    const auto ranking = ranked(std::move(summaries));
    cli::write_result(call, ranking_text(call, ranking, form));
    if (call.json) cli::print_json(call, cli::MissionComparison{cli::ranked_missions(ranking)});
    for (const auto& mission : missions)
        if (!call.json) cli::note_power_model(call, setup_of(mission));
    const int code = explain(call, ranking, is_sampled);
    return check_requirement(call, requirement, ranking) == cli::ok ? code : cli::requirement_missed;
}

}  // namespace

int flightwatt::stages::compare_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "compare", "MISSION.toml...",
        R"(Runs several missions and ranks them by final state of charge; of those that run empty, the one that
lasts longer comes first. A mission without a schedule is planned first, one with an adaptive policy in
flight. --json lists the summaries in that order. -o FILE.md writes the table as Markdown, -o FILE.csv as CSV
with all digits.)"};
    stage.next = [](const auto&) { return "flightwatt report OUT {in} -o report.html"; };
    stage.json_schema = cli::document_schema<cli::MissionComparison>;
    stage.examples = {"flightwatt compare missions/paper/*.toml",
                      "flightwatt compare a.toml b.toml --samples 2000 -o ranking.csv"};
    stage.uses_threads = stage.shows_table = true;
    cli::SamplingArguments arguments;
    cli::Requirement requirement;
    add_sampling_options(stage.options, arguments);
    add_require_option(stage.options, requirement, arguments);
    return cli::run_stage(argc, argv, stage,
                          [&](const auto& call) { return compare_missions(call, arguments, requirement); });
}
