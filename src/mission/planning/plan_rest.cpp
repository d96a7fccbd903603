#include "mission/planning/plan_rest.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

std::optional<std::size_t> choice_of(const Planner& planner, const compute::Configuration& run) {
    const auto& known = planner.depletions.configurations;
    const auto found = std::find(known.begin(), known.end(), run);
    if (found == known.end()) return std::nullopt;
    return static_cast<std::size_t>(found - known.begin());
}

MultipleChoiceKnapsack knapsack_of(const PlanningProblem& problem, const Planner& planner,
                                   const PlanStart& start, const std::vector<MissionSlot>& slots) {
    MultipleChoiceKnapsack knapsack;
    knapsack.utility_per_s = planner.utility_per_s;
    knapsack.free_choices = planner.free_choices;
    knapsack.dwell_s = problem.plan.dwell_s;
    if (start.running) {
        if (const auto choice = choice_of(planner, *start.running))
            knapsack.running = {*choice, start.running_for_s};
    }
    for (const auto& slot : slots) {
        KnapsackSlot choices{slot.duration_s(), std::nullopt, {}};
        if (slot.fixed) choices.fixed = choice_of(planner, *slot.fixed).value();
        double more_percent = 0.0;
        if (start.mechanical_factor != 1.0) {
            more_percent = (start.mechanical_factor - 1.0) *
                           soc_depletion_percent(planner.mechanical_depletion, {slot, 0});
        }
        for (std::size_t c = 0; c < planner.utility_per_s.size(); ++c) {
            choices.cost.push_back(soc_depletion_percent(planner.depletions, {slot, c}) + more_percent);
        }
        knapsack.slots.push_back(std::move(choices));
    }
    return knapsack;
}

std::vector<ScheduleSegment> schedule_of(const Planner& planner, const std::vector<MissionSlot>& slots,
                                         const std::vector<std::size_t>& choices) {
    std::vector<ScheduleSegment> schedule;
    for (std::size_t i = 0; i < slots.size(); ++i)
        append_merged(schedule, {slots[i], planner.depletions.configurations[choices[i]]});
    return schedule;
}

}  // namespace

Plan plan_rest(const PlanningProblem& problem, const Planner& planner, const PlanStart& start,
               double reserve_soc_percent, const KnapsackEffort& effort) {
    const auto slots = slots_of(problem, start.time_s);
    auto knapsack = knapsack_of(problem, planner, start, slots);
    knapsack.budget = start.soc_percent - reserve_soc_percent;
    const auto chosen = solve_knapsack(knapsack, effort);
    Plan plan;
    plan.feasible = chosen.feasible;
    plan.deliverable = chosen.possible;
    if (!chosen.possible) return plan;
    plan.schedule = schedule_of(planner, slots, chosen.choices);
    double duration_s = 0.0;
    for (const auto& slot : slots) duration_s += slot.duration_s();
    if (duration_s > 0.0) {
        plan.utility = chosen.utility / duration_s;
        plan.bound = chosen.bound / duration_s;
    }
    plan.final_soc_percent = start.soc_percent - chosen.cost;
    return plan;
}

}  // namespace flightwatt::mission
