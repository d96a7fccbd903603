#include "mission/plan.h"

#include "mission/planning/plan_by_simulation.h"
#include "mission/planning/plan_rest.h"
#include "mission/planning/reserve_deficit.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

constexpr int max_reserve_rounds = 20;

}  // namespace

MissionPlan plan_mission(const PlanningProblem& problem, const std::optional<double>& probability) {
    if (problem.battery.thevenin || problem.cutoff_voltage_v > 0.0)
        return plan_by_simulation(problem, probability);
    MissionPlan result;
    const auto planner = make_planner(problem);
    if (probability)
        result.margin_percent = margin_percent(problem, planner.depletions.configurations, *probability);
    const PlanStart start{0.0, problem.initial_soc_percent};
    const double wanted_percent = problem.reserve_soc_percent + result.margin_percent;
    double planned_percent = wanted_percent;
    std::optional<double> bound;
    std::vector<ScheduleSegment> schedule;
    bool lands = false;
    for (int round = 0; round < max_reserve_rounds && !lands; ++round) {
        result.plan = plan_rest(problem, planner, start, planned_percent);
        if (!bound) bound = result.plan.bound;
        result.plan.bound = result.plan.feasible ? *bound : 0.0;
        schedule = result.plan.deliverable ? result.plan.schedule : minimum_energy_schedule(problem);
        result.summary = simulate(problem, schedule).summary;
        if (!result.plan.feasible) break;
        const double deficit_percent = reserve_deficit_percent(problem, result.summary, wanted_percent);
        lands = result.summary.feasible && deficit_percent <= 0.0;
        planned_percent += std::max(deficit_percent, 0.0) + 1e-12;
    }
    result.plan.feasible = lands;  // where it is not: none was found, which is not to say that there is none
    result.flown = {problem, std::move(schedule)};
    return result;
}

MissionSummary labelled_summary(const MissionPlan& plan) {
    constexpr double as_good_as_optimal = 1e-3;
    auto summary = plan.summary;
    const double utility = summary.utility.value_or(0.0);
    const bool optimal =
        plan.plan.bound_is_proven && plan.plan.bound - utility <= as_good_as_optimal * plan.plan.bound;
    summary.feasible = summary.feasible && plan.plan.feasible;
    summary.schedule = !plan.plan.feasible ? ScheduleOrigin::infeasible
                       : optimal           ? ScheduleOrigin::optimal
                                           : ScheduleOrigin::planned;
    return summary;
}

}  // namespace flightwatt::mission
