#include "mission/plan.h"

#include "mission/flown_schedule.h"
#include "mission/planning/plan_by_simulation.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

constexpr int most_rounds = 20;

std::optional<std::size_t> choice_of(const Planner& planner, const compute::Configuration& run) {
    const auto& known = planner.drains.configurations;
    const auto found = std::find(known.begin(), known.end(), run);
    if (found == known.end()) return std::nullopt;
    return static_cast<std::size_t>(found - known.begin());
}

SlotChoiceProblem problem_of(const Mission& mission, const Planner& planner, const PlanStart& start,
                             const std::vector<MissionSlot>& slots) {
    SlotChoiceProblem problem;
    problem.worth_per_s = planner.worth_per_s;
    problem.free_choices = planner.free_choices;
    problem.dwell_s = mission.plan->dwell_s;
    if (start.running) {
        if (const auto choice = choice_of(planner, *start.running))
            problem.running = {*choice, start.running_for_s};
    }
    for (const auto& slot : slots) {
        ChoiceSlot choices{slot.to_s - slot.from_s, std::nullopt, {}};
        if (slot.fixed) choices.fixed = choice_of(planner, *slot.fixed).value();
        double more_percent = 0.0;
        if (start.mechanical_factor != 1.0) {
            more_percent = (start.mechanical_factor - 1.0) *
                           drain_percent(planner.mechanical_drains, {0, slot.phase, slot.from_s, slot.to_s});
        }
        for (std::size_t c = 0; c < planner.worth_per_s.size(); ++c) {
            choices.drain.push_back(drain_percent(planner.drains, {c, slot.phase, slot.from_s, slot.to_s}) +
                                    more_percent);
        }
        problem.slots.push_back(std::move(choices));
    }
    return problem;
}

/// Neighbours of one phase that run the same become one.
std::vector<Stretch> schedule_of(const Planner& planner, const std::vector<MissionSlot>& slots,
                                 const std::vector<std::size_t>& choices) {
    std::vector<Stretch> schedule;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const auto& run = planner.drains.configurations[choices[i]];
        if (!schedule.empty() && schedule.back().phase == slots[i].phase && schedule.back().run == run) {
            schedule.back().to_s = slots[i].to_s;
        } else {
            schedule.push_back({slots[i].phase, slots[i].from_s, slots[i].to_s, run});
        }
    }
    return schedule;
}

}  // namespace

Plan plan_rest(const Mission& mission, const Planner& planner, const PlanStart& start,
               double reserve_soc_percent, const SlotChoiceEffort& effort) {
    const auto slots = slots_of(mission, start.time_s);
    auto problem = problem_of(mission, planner, start, slots);
    problem.budget = start.soc_percent - reserve_soc_percent;
    const auto chosen = choose_slots(problem, effort);
    Plan plan;
    plan.feasible = chosen.feasible;
    plan.deliverable = chosen.possible;
    if (!chosen.possible) return plan;
    plan.schedule = schedule_of(planner, slots, chosen.choices);
    double duration_s = 0.0;
    for (const auto& slot : slots) duration_s += slot.to_s - slot.from_s;
    if (duration_s > 0.0) {
        plan.utility = chosen.worth / duration_s;
        plan.bound = chosen.bound / duration_s;
    }
    plan.final_soc_percent = start.soc_percent - chosen.drain;
    return plan;
}

MissionPlan plan_mission(const Mission& mission, const std::optional<double>& probability) {
    if (mission.battery.thevenin || mission.cutoff_voltage_v > 0.0)
        return plan_by_simulation(mission, probability);
    MissionPlan result;
    result.planner = make_planner(mission);
    const auto& planner = result.planner;
    if (probability)
        result.margin_percent = margin_percent(mission, planner.drains.configurations, *probability);
    const PlanStart start{0.0, mission.initial_soc_percent, std::nullopt, 0.0};
    const double wanted_percent = mission.reserve_soc_percent + result.margin_percent;
    double planned_percent = wanted_percent;
    std::optional<double> bound;
    for (int round = 0; round < most_rounds; ++round) {
        result.plan = plan_rest(mission, planner, start, planned_percent);
        if (!bound) bound = result.plan.bound;
        result.plan.bound = result.plan.feasible ? *bound : 0.0;
        result.flown = result.plan.deliverable ? with_schedule(mission, result.plan.schedule)
                                               : with_least_schedule(mission);
        result.summary = simulate(result.flown).summary;
        if (!result.plan.feasible) return result;
        const double missing = missing_percent(mission, result.summary, wanted_percent);
        if (result.summary.feasible && missing <= 0.0) return result;
        planned_percent += std::max(missing, 0.0) + 1e-12;
    }
    result.plan.feasible = false;  // not found, which is not to say that there is none
    return result;
}

MissionSummary labelled_summary(const MissionPlan& plan) {
    constexpr double as_good_as_optimal = 1e-3;
    auto summary = plan.summary;
    const double utility = summary.utility.value_or(0.0);
    const bool optimal =
        plan.plan.bound_is_proven && plan.plan.bound - utility <= as_good_as_optimal * plan.plan.bound;
    summary.feasible = summary.feasible && plan.plan.feasible;
    summary.schedule = !plan.plan.feasible ? "no plan keeps the reserve" : optimal ? "optimal" : "planned";
    return summary;
}

}  // namespace flightwatt::mission
