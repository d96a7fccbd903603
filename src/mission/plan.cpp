#include "mission/plan.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "mission/planning/planner.h"
#include "mission/planning/survey_layouts.h"
#include "mission/sampling/flight_spreads.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr int max_rounds_to_land = 10;
constexpr int max_margin_rounds = 8;
constexpr int max_rounds_to_any = 24;  ///< until a plan is better than the one of least energy demand
constexpr SearchLimits quick_search{1e-4, 5, 4};
constexpr double slack_fraction = 2e-3;  // of the flights' deviation: 0.0002 of a probability of 0.05

/// How far below `wanted_percent` a simulated mission ends [points], counting what it demanded after the
/// battery ended as a fraction of its full energy. Negative if there is more.
double reserve_deficit_percent(const MissionSetup& mission, const MissionSummary& summary, double wanted_percent) {
    const double deficit = wanted_percent - summary.final_soc_percent.value_or(0.0);
    if (summary.feasible) return deficit;
    // The charge left after a cut-off cannot serve the later demand.
    return std::max(deficit, 0.0) +
           units::percentage(summary.energy_wh - summary.delivered_energy_wh, full_energy_wh(mission.battery));
}

/// A schedule, simulated.
struct Trial {
    Schedule schedule;
    MissionSummary summary;
    double deficit_percent = 0.0;

    bool lands() const { return summary.feasible && deficit_percent <= 0.0; }
};

Trial fly(const PlanningProblem& problem, Schedule schedule) {
    Trial trial{std::move(schedule), {}, 0.0};
    trial.summary = simulate(problem.setup, trial.schedule).summary;
    trial.deficit_percent = reserve_deficit_percent(problem.setup, trial.summary, problem.setup.reserve_soc_percent);
    return trial;
}

PlanStart start_of(const PlanningProblem& problem) { return {0.0, problem.setup.initial_soc_percent}; }

/// Tightens the limit that the simulated schedule misses, by rounding or because a full battery refused charge.
void make_stricter(const Trial& trial, double part, double slack_percent, PlanningProblem& problem) {
    if (trial.summary.undeliverable)
        problem.setup.battery.resistance_ohm *= 1.0 + part;
    else if (trial.summary.cut_off_at_s)
        problem.setup.cutoff_voltage_v *= 1.0 + part;
    else
        problem.setup.reserve_soc_percent += std::max(trial.deficit_percent, 0.0) + slack_percent;
}

/// The best schedule found that lands, and into `plan` the bound of the problem as stated.
Trial searched(const PlanningProblem& problem, const PlanningTables& planner, const Trial& least, Plan& plan) {
    constexpr double slack_percent = 3e-6;  // error of a search
    auto stricter = problem;
    double part = 1e-8;
    for (int round = 0; round < max_rounds_to_land; ++round) {
        const auto found = plan_remaining(stricter, planner, start_of(problem), stricter.setup.reserve_soc_percent);
        if (round == 0) {
            plan.utility_bound = found.utility_bound;
            plan.bound_is_proven = found.bound_is_proven;
        }
        if (!found.feasible) break;
        auto trial = fly(problem, found.schedule);
        if (trial.lands()) return trial;
        make_stricter(trial, part *= 10.0, slack_percent, stricter);
    }
    return least;
}

/// The plan of a mission whose flights do not differ. If the schedule of least energy demand does not land, none does:
/// it keeps the most charge and the highest voltage at any time.
MissionPlan plan_certain(const PlanningProblem& problem) {
    const auto planner = make_planning_tables(problem);
    MissionPlan result;
    auto& plan = result.plan;
    auto found = fly(problem, minimum_energy_schedule(problem));
    plan.feasible = found.lands();
    if (plan.feasible) {
        found = searched(problem, planner, found, plan);
        plan.utility_bound += coverage_utility(problem.setup);
        plan.utility = found.summary.utility.value_or(0.0);
        plan.utility_bound = std::max(plan.utility_bound, plan.utility);
    }
    plan.schedule = std::move(found.schedule);
    plan.final_soc_percent = problem.setup.reserve_soc_percent - found.deficit_percent;
    result.summary = std::move(found.summary);
    result.mission = {problem.setup, plan.schedule};
    return result;
}

/// Makes the bound of a plan that of the problem as stated, in less time than the plan of that takes: margins differ
/// between schedules, and one with a smaller margin may have more utility than any with the plan's.
void set_bound_as_stated(const PlanningProblem& problem, Plan& plan) {
    const auto best = plan_remaining(problem, make_planning_tables(problem), start_of(problem),
                                     problem.setup.reserve_soc_percent, quick_search);
    plan.utility_bound = std::max(best.utility_bound + coverage_utility(problem.setup), plan.utility);
    plan.bound_is_proven = best.bound_is_proven;
}

/// The schedule of least energy demand as a plan.
MissionPlan least_plan(const PlanningProblem& problem, const FlightUncertainty& spreads, double probability) {
    MissionPlan plan;
    plan.mission = with_minimum_energy_schedule(problem);
    plan.summary = simulate(plan.mission).summary;
    plan.plan.schedule = plan.mission.schedule;
    const auto landings = draw_landings(plan.mission, spreads);
    plan.margin_percent = landings.nominal_percent - landings.quantile_percent(probability);
    plan.plan.final_soc_percent = landings.nominal_percent;
    plan.plan.feasible = plan.summary.keeps_reserve && landings.below() <= 1.0 - probability;
    plan.plan.utility = plan.summary.utility.value_or(0.0);
    return plan;
}

/// Plans with the least margin above the reserve with which enough of the plan's flights keep it.
MissionPlan plan_with_probability(const PlanningProblem& problem, double probability) {
    require_known_spread(problem.setup);
    const auto spreads = collect_uncertainty(problem.setup);
    auto best = least_plan(problem, spreads, probability);
    best.sources = spreads.sources;
    if (!best.plan.feasible) return best;
    MarginSearch search(best.margin_percent);
    bool is_least = true;
    LandingDistribution landings;
    Schedule last;
    for (int round = 0; round < (is_least ? max_rounds_to_any : max_margin_rounds) && !search.has_converged();
         ++round) {
        const double planned_percent = std::max(search.margin_percent(), 0.0);  // as stated, it keeps the reserve too
        auto stricter = problem;
        stricter.setup.reserve_soc_percent += planned_percent;
        auto plan = plan_certain(stricter);
        if (!plan.plan.feasible) {
            search.mark_infeasible();
            continue;
        }
        plan.mission.setup.reserve_soc_percent = problem.setup.reserve_soc_percent;
        if (plan.mission.schedule != last) landings = draw_landings_until_known(plan.mission, spreads, probability);
        last = plan.mission.schedule;
        const double slack_percent = landings.spare_percent(probability);
        const double close_percent = slack_fraction * landings.sd_percent;
        search.add_result(slack_percent, close_percent / 2.0);
        if (slack_percent < 0.0) continue;
        const bool is_same = plan.mission.schedule == best.mission.schedule;
        if (is_least || *plan.summary.utility >= *best.summary.utility) {
            plan.sources = spreads.sources;
            plan.probability_standard_error = landings.standard_error();
            best = std::move(plan);
        }
        if (slack_percent <= close_percent || planned_percent == 0.0 || (is_same && !is_least)) break;
        is_least = false;
    }
    best.summary = simulate(best.mission).summary;
    best.plan.utility = best.summary.utility.value_or(0.0);
    set_bound_as_stated(problem, best.plan);
    const auto best_landings = draw_landings(best.mission, spreads);
    best.margin_percent = std::max(best_landings.nominal_percent - best_landings.quantile_percent(probability), 0.0);
    return best;
}

MissionPlan plan_lines_as_stated(const PlanningProblem& problem, const std::optional<double>& probability) {
    return probability ? plan_with_probability(problem, *probability) : plan_certain(problem);
}

/// A way to cover an area, with what its schedules can reach at most.
struct BoundedLayout {
    path::SurveyLayout layout;
    std::optional<InputError> refused = std::nullopt;  ///< why its path cannot be flown
    bool lands = false;
    bool bound_is_proven = true;
    double utility_bound = 0.0;
    double least_percent = 0.0;  ///< charge at the end with the schedule of least energy demand
    double least_wh = 0.0;       ///< mechanical energy of its path
};

/// Bounds the utility by a quick search.
BoundedLayout bounded(const PlanningProblem& problem, const path::SurveyLayout& layout) {
    BoundedLayout result{layout};
    try {
        const auto flown = problem.survey->mission_with(layout);
        const auto tables = make_planning_tables(flown);
        const auto plan = plan_remaining(flown, tables, start_of(flown), flown.setup.reserve_soc_percent, quick_search);
        result.lands = plan.feasible;
        result.bound_is_proven = plan.bound_is_proven;
        if (plan.feasible)
            result.utility_bound =
                (plan.bound_is_proven ? plan.utility_bound : std::ranges::max(tables.utility_per_s)) +
                coverage_utility(flown.setup);
        result.least_percent = plan.final_soc_percent;
        result.least_wh =
            units::wh_from_joule(mean_level_w(flown.setup, Phase::cruise) * flown.setup.duration_s[Phase::cruise]);
    } catch (const InputError& error) {
        result.refused = error;
    }
    return result;
}

MissionPlan plan_with_lines(const PlanningProblem& problem, const std::optional<double>& probability) {
    constexpr double as_good = 1.0 + 1e-5;  // a plan's own gap is as large
    make_planning_tables(problem);          // throws for all
    const auto layouts = all_layouts(*problem.survey);
    std::vector<BoundedLayout> ways(layouts.size());
    for_each_in_parallel(layouts.size(), [&](std::size_t i) { ways[i] = bounded(problem, layouts[i]); });
    std::ranges::stable_sort(ways, std::greater(), [](const BoundedLayout& way) {
        return std::tuple(!way.refused, way.lands, way.utility_bound, way.least_percent, -way.least_wh);
    });
    if (ways.front().refused) throw *ways.front().refused;
    std::optional<MissionPlan> best;
    double utility_bound = 0.0;
    for (const auto& way : ways) {
        const double known = best && best->plan.feasible ? best->plan.utility : -1.0;
        if (best && (!way.lands || way.utility_bound <= known * as_good)) {
            if (way.lands) utility_bound = std::max(utility_bound, way.utility_bound);
            break;
        }
        auto plan = plan_lines_as_stated(problem.survey->mission_with(way.layout), probability);
        plan.plan.utility = plan.summary.utility.value_or(0.0);
        if (plan.plan.feasible) utility_bound = std::max(utility_bound, plan.plan.utility_bound);
        const auto merit = [](const Plan& of) {
            return std::pair(of.feasible, of.feasible ? of.utility : of.final_soc_percent);
        };
        const bool is_better = !best || merit(plan.plan) > merit(best->plan);
        if (is_better) best = std::move(plan);
    }
    const auto refused = std::ranges::count_if(ways, [](const auto& way) { return way.refused.has_value(); });
    if (refused > 0)
        best->mission.setup.notes.push_back(
            fmt::format("{} of {} ways to cover the area cannot be flown, for example: {}", refused, ways.size(),
                        ways.back().refused->what()));
    best->plan.utility_bound = best->plan.feasible ? std::max(utility_bound, best->plan.utility) : 0.0;
    best->plan.bound_is_proven = std::ranges::all_of(ways, &BoundedLayout::bound_is_proven);
    return std::move(*best);
}

}  // namespace

bool has_uncertainty(const MissionSetup& mission) { return !collect_uncertainty(mission).sources.varied.empty(); }

void require_uncertainty(const MissionSetup& mission) {
    if (has_uncertainty(mission)) return;
    throw InputError({mission.file},
                     "there is nothing to draw flights from: mechanical model, profiles and battery have no "
                     "variability between flights",
                     "fit the model to two flights or more (flightwatt fit), or state it: [uncertainty] with "
                     "level_sd_percent = { cruise = 5 }, duration_sd_s = { cruise = 20 }, "
                     "compute_sd_percent, capacity_sd_percent or initial_soc_sd_percent");
}

void require_known_spread(const MissionSetup& mission) {
    if (mission.mechanical)
        require_flight_variability(mission);
    else
        require_uncertainty(mission);
}

MissionPlan plan_mission(const PlanningProblem& problem, const std::optional<double>& probability) {
    return problem.survey ? plan_with_lines(problem, probability) : plan_lines_as_stated(problem, probability);
}

MissionSummary summary_with_origin(const MissionPlan& plan) {
    constexpr double as_good_as_optimal = 1e-3;
    auto summary = plan.summary;
    const double utility = summary.utility.value_or(0.0);
    const bool optimal =
        plan.plan.bound_is_proven && plan.plan.utility_bound - utility <= as_good_as_optimal * plan.plan.utility_bound;
    summary.feasible = summary.feasible && plan.plan.feasible;
    summary.schedule = !plan.plan.feasible ? ScheduleOrigin::infeasible
                       : optimal           ? ScheduleOrigin::optimal
                                           : ScheduleOrigin::planned;
    return summary;
}

}  // namespace flightwatt::mission
