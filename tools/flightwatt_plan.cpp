// A mission to the schedule of most utility that lands with the reserve; and what is feasible at most.

#include "base/atomic_file.h"
#include "base/duration_text.h"
#include "base/error.h"
#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/plan.h"
#include "stages.h"

#include <filesystem>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// A mission file and its text: it may be read several times, and is written again with its schedule.
struct MissionFile {
    std::filesystem::path path;
    std::string text;

    mission::MissionVariant read(mission::MissionReadOptions reading = {}) const {
        reading.allow_unplanned = true;
        return mission::parse_mission(text, path, reading);
    }
    mission::MissionVariant read_with_cruise(double cruise_s) const { return read({.cruise_s = cruise_s}); }
};

std::optional<double> probability(const cli::StageCall& call) {
    const auto given = call.get_optional<double>("probability");
    if (given && !(*given >= 0.5 && *given < 1.0)) {
        throw UsageError(fmt::format("--probability {}: expected 0.5 or more, and less than 1", *given));
    }
    return given;
}

std::string describe(const mission::MissionPlan& plan, const mission::MissionSetup& mission) {
    const double utility = *plan.summary.utility;
    const double gap = plan.plan.utility_bound > 0.0
                           ? units::percentage(plan.plan.utility_bound - utility, plan.plan.utility_bound)
                           : 0.0;
    const auto bound =
        plan.plan.bound_is_proven
            ? fmt::format("at most {:.6g} is possible (gap {:.4f} %)", plan.plan.utility_bound, std::max(gap, 0.0))
            : "how much is possible is not known, as the battery is charged in flight";
    auto text = fmt::format("{}: utility {:.6g}, {}; {:.4f} % left, reserve {:.4f} %", mission.name, utility, bound,
                            *plan.summary.final_soc_percent, mission.reserve_soc_percent);
    if (plan.sources) text += fmt::format(" and {:.4f} points of margin", plan.margin_percent);
    if (plan.summary.by_flights) text += fmt::format(" ({})", describe(*plan.summary.by_flights));
    return text;
}

/// What the chance that was asked for holds for.
void note_sources(const cli::StageCall& call, const mission::MissionSetup& mission,
                  const mission::UncertaintySources& sources, double standard_error = 0.0) {
    constexpr double worth_saying = 5e-4;
    const auto exactness = standard_error < worth_saying ? "" : fmt::format(" (computed to +- {:.4f})", standard_error);
    cli::note(call, fmt::format("{}: chance {}{} over flights as --samples draws them; {}", mission.name,
                                *probability(call), exactness, describe(sources)));
}

[[noreturn]] void refuse_infeasible(const cli::StageCall& call, const MissionFile& file,
                                    const mission::PlanningProblem& problem, const mission::MissionPlan& plan) {
    if (!plan.plan.deliverable) throw NoResultError(describe(plan.summary));
    const auto report = infeasibility_report(
        problem, plan, [&](double cruise_s) { return file.read_with_cruise(cruise_s); }, probability(call));
    if (call.json) {
        auto json = cli::to_json(plan, problem.setup);
        json["shortfall"] = cli::to_json(report);
        cli::print(cli::json_text(json));
    }
    throw NoResultError(fmt::format("{}: {}", problem.setup.name, describe(problem.setup, report)));
}

int make_plan(const cli::StageCall& call, const MissionFile& file) {
    const auto chance = probability(call);
    const auto mission = file.read();
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem == nullptr) {
        throw InputError({setup_of(mission).file}, "the mission has a schedule already: there is nothing to plan",
                         "add [plan], and what [[schedule]] says is fixed and the rest planned");
    }
    cli::warn_of_setup(call, problem->setup);
    auto plan = plan_mission(*problem, chance);
    plan.summary.by_flights = landing_by_flights(problem->setup, plan.mission.schedule);
    if (!plan.plan.feasible) refuse_infeasible(call, file, *problem, plan);
    const auto text = describe(plan, problem->setup);
    // The files that the result names are found from where it will stand.
    const auto folder = std::filesystem::absolute(call.output.value_or("result")).parent_path();
    const auto planned =
        planned_mission_toml(file.text, file.path, problem->setup.compute, plan.mission.schedule, folder);
    cli::write_result(call, fmt::format("# {}\n", cli::one_line(text)) + planned.text);
    cli::warn_of_lost_comments(call, planned);
    if (call.json) {
        cli::print(cli::json_text(cli::to_json(plan, problem->setup)));
    } else {
        cli::note(call, text);
        cli::note_power_model(call, problem->setup);
        if (plan.sources) note_sources(call, problem->setup, *plan.sources, plan.probability_standard_error);
    }
    return cli::ok;
}

/// What the battery does beyond a limit; empty if charge is what ends it.
std::string_view beyond(mission::LimitingFactor bound) {
    switch (bound) {
        case mission::LimitingFactor::power:
            return "; beyond, the battery cannot deliver the power";
        case mission::LimitingFactor::cut_off:
            return "; beyond, the battery is cut off";
        case mission::LimitingFactor::charge:
            break;
    }
    return "";
}

int answer(const cli::StageCall& call, const mission::MissionSetup& mission, const std::string& question,
           const std::string& unit, const mission::FeasibilityLimit& most) {
    cli::warn_of_setup(call, mission);
    cli::Json json;
    json["mission"] = mission.name;
    json[question] = most.value;
    json["final_soc_percent"] = most.final_soc_percent;
    json["reserve_soc_percent"] = mission.reserve_soc_percent;
    if (const auto chance = probability(call)) {
        json["probability"] = *chance;
        json["margin_percent"] = most.margin_percent;
        cli::add_sources(*most.sources, json);
    }
    json["residual_percent"] = most.residual_percent;
    json["limited_by"] = to_string(most.limited_by);
    const bool in_minutes = unit == "s" && !call.output && screen_of(call).is_terminal;
    const auto value = fmt::format("{:.6f} {}\n", most.value, unit);
    cli::write_result(call, in_minutes ? duration_text(most.value) + "\n" : value);
    if (call.json) {
        cli::print(cli::json_text(json));
    } else {
        const auto kept = probability(call) ? fmt::format("reserve {:.4f} % and {:.4f} points of margin",
                                                          mission.reserve_soc_percent, most.margin_percent)
                                            : fmt::format("reserve {:.4f} %", mission.reserve_soc_percent);
        cli::note(call, fmt::format("{}: then {:.4f} % are left, {}{}", mission.name, most.final_soc_percent, kept,
                                    beyond(most.limited_by)));
        cli::note_power_model(call, mission);
        if (most.sources) note_sources(call, mission, *most.sources);
    }
    return cli::ok;
}

/// --longest-cruise.
int answer_reach(const cli::StageCall& call, const MissionFile& file) {
    const auto reach = mission::find_reach(
        [&](const mission::MissionReadOptions& reading) { return file.read(reading); }, probability(call));
    const auto mission = file.read();
    const auto& setup = setup_of(mission);
    switch (reach.unit) {
        case mission::ReachUnit::circles:
            return answer(call, setup, "most_circles", "circles", reach.limit);
        case mission::ReachUnit::return_m:
            return answer(call, setup, "farthest_return_m", "m", reach.limit);
        case mission::ReachUnit::cruise_s:
            break;
    }
    return answer(call, setup, "longest_cruise_s", "s", reach.limit);
}

int plan_file(const cli::StageCall& call) {
    const MissionFile file{call.inputs.front(), read_file(call.inputs.front())};
    const bool cruise = call.has("longest-cruise");
    const bool payload = call.has("largest-payload");
    if (cruise && payload) throw UsageError("--longest-cruise and --largest-payload are two questions: ask one");
    if (cruise) return answer_reach(call, file);
    if (payload) {
        const auto mission = file.read();
        return answer(call, setup_of(mission), "largest_payload_w", "W", largest_payload(mission, probability(call)));
    }
    return make_plan(call, file);
}

}  // namespace

int flightwatt::stages::plan_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "plan", "MISSION.toml",
        R"(Makes the schedule of most utility that still lands with the reserve, and proves how much better any
other could be. The result is the mission with that schedule, for simulate and compare. What [[schedule]]
says beside [plan] is fixed. --longest-cruise and --largest-payload take the mission's own schedule, or the
one that demands least energy. On a battery whose voltage falls with its charge (model = "thevenin"), or with a
cut-off voltage, the battery itself is followed through every schedule that could be the best.)"};
    stage.max_inputs = 1;
    auto add = stage.options.add_options();
    add("probability", cli::value<double>("P"),
        "keep the reserve with this chance, 0.5 or more, as flights differ; default: as modelled");
    add("longest-cruise",
        "instead: the longest cruise that lands with the reserve [s]; of a [path] the most circles, or without any the "
        "farthest from where the mission returns [m]");
    add("largest-payload", "instead: the largest constant power that can be fed besides [W]");
    return flightwatt::cli::run_stage(argc, argv, stage, plan_file);
}
