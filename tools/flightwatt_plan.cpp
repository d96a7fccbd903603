// A mission to the schedule that is worth most and lands with the reserve; and the inverse questions.

#include "base/atomic_file.h"
#include "base/units.h"
#include "cli/output/plan_json.h"
#include "cli/stage.h"
#include "mission/feasibility_limits.h"
#include "mission/infeasibility_report.h"
#include "mission/plan.h"
#include "mission/planned_mission_file.h"

#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// A mission file and its text: it may be read several times, and is written again with its schedule.
struct MissionFile {
    std::filesystem::path path;
    std::string text;

    mission::Mission read(std::optional<double> cruise_s = {}) const {
        return mission::parse_mission(text, path, {true, cruise_s});
    }
};

/// Where the result will stand, as the files that it names are found from there.
std::filesystem::path folder_of_result(const cli::StageCall& call) {
    return call.output ? std::filesystem::absolute(*call.output).parent_path()
                       : std::filesystem::current_path();
}

std::optional<double> probability(const cli::StageCall& call) {
    const auto given = call.maybe<double>("probability");
    if (given && !(*given >= 0.5 && *given < 1.0)) {
        throw UsageError(fmt::format("--probability {}: expected 0.5 or more, and less than 1", *given));
    }
    return given;
}

std::string describe(const mission::MissionPlan& plan, const mission::Mission& mission) {
    const double utility = *plan.summary.utility;
    const double gap =
        plan.plan.bound > 0.0 ? units::percent_of(plan.plan.bound - utility, plan.plan.bound) : 0.0;
    const auto bound =
        plan.plan.bound_is_proven
            ? fmt::format("at most {:.6g} is possible (gap {:.4f} %)", plan.plan.bound, std::max(gap, 0.0))
            : "how much is possible is not known, as the battery is charged in flight";
    auto text = fmt::format("{}: utility {:.6g}, {}; {:.4f} % left, reserve {:.4f} %", mission.name, utility,
                            bound, *plan.summary.final_soc_percent, mission.reserve_soc_percent);
    if (plan.margin_percent > 0.0) text += fmt::format(" and {:.4f} points of margin", plan.margin_percent);
    return text;
}

[[noreturn]] void refuse_infeasible(const cli::StageCall& call, const MissionFile& file,
                                    const mission::Mission& mission, const mission::MissionPlan& plan) {
    if (!plan.plan.deliverable) throw NoAnswerError(describe(plan.summary));
    const auto shortfall = shortfall_of(mission, plan, [&](double cruise_s) { return file.read(cruise_s); });
    if (call.json) {
        auto json = cli::to_json(plan, mission);
        json["shortfall"] = cli::to_json(shortfall);
        cli::print(cli::json_text(json));
    }
    throw NoAnswerError(fmt::format("{}: {}", mission.name, describe(mission, shortfall)));
}

int make_plan(const cli::StageCall& call, const MissionFile& file) {
    const auto mission = file.read();
    if (!mission.plan) {
        throw InputError({mission.file}, "the mission has a schedule already: there is nothing to plan",
                         "add [plan], and what [[schedule]] says is fixed and the rest planned");
    }
    const auto plan = plan_mission(mission, probability(call));
    if (!plan.plan.feasible) refuse_infeasible(call, file, mission, plan);
    const auto heading = fmt::format("# {}\n", cli::one_line(describe(plan, mission)));
    cli::write_result(
        call, heading + planned_mission_toml(file.text, file.path, plan.flown, folder_of_result(call)));
    if (call.json) {
        cli::print(cli::json_text(cli::to_json(plan, mission)));
    } else {
        cli::note(call, describe(plan, mission));
    }
    return cli::ok;
}

int answer(const cli::StageCall& call, const mission::Mission& mission, const std::string& question,
           const std::string& unit, const mission::MostThatLands& most) {
    nlohmann::ordered_json json;
    json["mission"] = mission.name;
    json[question] = most.value;
    json["final_soc_percent"] = most.final_soc_percent;
    json["reserve_soc_percent"] = mission.reserve_soc_percent;
    json["residual_percent"] = most.residual_percent;
    json["limited_by"] = most.power_is_the_limit ? "power" : most.cut_off_is_the_limit ? "cut-off" : "charge";
    cli::write_result(call, fmt::format("{:.6f} {}\n", most.value, unit));
    if (call.json) {
        cli::print(cli::json_text(json));
    } else {
        cli::note(call, fmt::format("{}: then {:.6f} % are left, {:+.1e} points from the reserve{}",
                                    mission.name, most.final_soc_percent, most.residual_percent,
                                    most.power_is_the_limit ? "; beyond, the battery cannot deliver the power"
                                    : most.cut_off_is_the_limit ? "; beyond, the battery is cut off"
                                                                : ""));
    }
    return cli::ok;
}

int plan_file(const cli::StageCall& call) {
    const MissionFile file{call.inputs.front(), read_file(call.inputs.front())};
    const bool cruise = call.has("longest-cruise");
    const bool payload = call.has("largest-payload");
    if (cruise && payload)
        throw UsageError("--longest-cruise and --largest-payload are two questions: ask one");
    if ((cruise || payload) && call.has("probability")) {
        throw UsageError("--probability belongs to a plan, not to --longest-cruise or --largest-payload");
    }
    if (cruise) {
        const auto most = mission::longest_cruise([&](double cruise_s) { return file.read(cruise_s); });
        return answer(call, file.read(), "longest_cruise_s", "s", most);
    }
    if (payload) {
        const auto mission = file.read();
        return answer(call, mission, "largest_payload_w", "W", largest_payload(mission));
    }
    return make_plan(call, file);
}

}  // namespace

int main(int argc, char** argv) {
    namespace po = boost::program_options;
    flightwatt::cli::StageDefinition stage;
    stage.name = "plan";
    stage.arguments = "MISSION.toml";
    stage.description =
        "Makes the schedule that is worth most and still lands with the reserve, and proves how much better "
        "any\n"
        "other could be. The result is the mission with that schedule, for simulate and compare. What "
        "[[schedule]]\n"
        "says beside [plan] is fixed. --longest-cruise and --largest-payload take the mission's own "
        "schedule, or the\n"
        "one that drains least. On a battery whose voltage falls with its charge (model = \"thevenin\"), "
        "plans are\n"
        "simulated and made anew until they land; the bound is then that of the highest voltage possible.";
    stage.max_inputs = 1;
    stage.options.add_options()("probability", po::value<double>()->value_name("P"),
                                "keep the reserve with this chance, as flights differ (0.95)")(
        "longest-cruise", "instead: the longest cruise that lands with the reserve [s]")(
        "largest-payload", "instead: the largest constant power that can be fed besides [W]");
    return flightwatt::cli::run_stage(argc, argv, stage, plan_file);
}
