#include "mission/planning/planner.h"

#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double max_combinations = 1e6;
constexpr double max_slots = 20000;

struct Choice {
    compute::Configuration run;
    double power_w = 0.0;
    double utility_per_s = 0.0;
};

/// Returns whether a draws less power than b, or as much for more utility.
bool draws_less(const Choice& a, const Choice& b) {
    return a.power_w != b.power_w ? a.power_w < b.power_w : a.utility_per_s > b.utility_per_s;
}

/// Returns each of `starts` with each of `values`, which `add` appends.
template <typename Start, typename Values, typename Add>
std::vector<Start> combined(const std::vector<Start>& starts, const Values& values, const Add& add) {
    std::vector<Start> all;
    for (const auto& value : values) {
        for (const auto& start : starts) {
            all.push_back(start);
            add(all.back(), value);
        }
    }
    return all;
}

/// Returns every way to run one component; the empty one is off.
std::vector<compute::Configuration> ways_to_run(std::size_t component, const ComponentChoices& choices) {
    std::vector<compute::Configuration> ways{{{component, {}}}};
    for (const auto& levels : choices.levels)
        ways = combined(ways, levels, [](auto& way, double level) { way.front().qos.push_back(level); });
    if (choices.may_be_off) ways.emplace_back();
    return ways;
}

void require_few(const PlanningProblem& problem) {
    double combinations = 1.0;
    for (const auto& component : problem.plan.choices) {
        const double ways =
            std::accumulate(component.levels.begin(), component.levels.end(), 1.0,
                            [](double all, const auto& levels) { return all * static_cast<double>(levels.size()); });
        combinations *= ways + (component.may_be_off ? 1.0 : 0.0);
    }
    if (combinations <= max_combinations) return;
    throw InputError({problem.setup.file},
                     fmt::format("the components have {:.3g} combinations of levels, more than {:.0e} to choose from",
                                 combinations, max_combinations),
                     "restrict the choices with `levels` in [plan]");
}

std::vector<Choice> every_choice(const PlanningProblem& problem) {
    std::vector<compute::Configuration> runs{{}};
    for (std::size_t i = 0; i < problem.plan.choices.size(); ++i)
        runs = combined(runs, ways_to_run(i, problem.plan.choices[i]),
                        [](auto& run, const auto& way) { run.insert(run.end(), way.begin(), way.end()); });
    std::vector<Choice> choices;
    choices.reserve(runs.size());
    for (auto& run : runs) {
        const double draws_w = power_w(problem.setup.compute, run);
        const double per_s = utility_per_s(problem.setup.utilities, run);
        choices.push_back({std::move(run), draws_w, per_s});
    }
    return choices;
}

/// Returns the choices with more utility than all that draw less, and those of `kept`: with a dwell time, continuing a
/// fixed configuration can be better than a change.
std::vector<Choice> undominated(std::vector<Choice> choices, const std::vector<compute::Configuration>& kept) {
    std::ranges::stable_sort(choices, draws_less);
    std::optional<double> most;
    std::erase_if(choices, [&](const Choice& choice) {
        const bool better = !most || choice.utility_per_s > *most;
        if (better) most = choice.utility_per_s;
        return !better && std::ranges::find(kept, choice.run) == kept.end();
    });
    return choices;
}

/// Appends the slots of a time in which nothing is fixed.
void add_free_slots(PhaseSegment free, double slot_s, double tolerance_s, std::vector<MissionSlot>& slots) {
    while (free.start_s < free.end_s - tolerance_s) {
        const double next_s = (std::floor((free.start_s + tolerance_s) / slot_s) + 1.0) * slot_s;
        const double end_s = next_s < free.end_s - tolerance_s ? next_s : free.end_s;
        slots.push_back({{free.phase, free.start_s, end_s}, std::nullopt});
        free.start_s = end_s;
    }
}

void require_few_slots(const PlanningProblem& problem, double duration_s) {
    double slots = 0.0;
    for (const auto phase : all_phases)
        slots += problem.setup.duration_s[phase] / (problem.plan.slot_s * problem.plan.slot_scale[phase]);
    if (slots <= max_slots) return;
    throw InputError(
        {problem.setup.file},
        fmt::format("{:.6g} s in slots of {:.6g} s are more than {} slots", duration_s, problem.plan.slot_s, max_slots),
        "make slot_s in [plan] longer");
}

/// Returns the index of a configuration; none if it is not among the choices.
std::optional<std::size_t> index_of(const PlanningTables& planner, const compute::Configuration& run) {
    const auto found = std::ranges::find(planner.configurations, run);
    if (found == planner.configurations.end()) return std::nullopt;
    return static_cast<std::size_t>(found - planner.configurations.begin());
}

ScheduleChoices choices_of(const PlanningProblem& problem, const PlanningTables& planner, const PlanStart& start,
                           const std::vector<MissionSlot>& slots) {
    ScheduleChoices choices{{}, planner.utility_per_s, planner.free_choices, problem.plan.dwell_s, std::nullopt};
    if (start.running) {
        if (const auto choice = index_of(planner, *start.running)) choices.running = {*choice, start.running_for_s};
    }
    for (const auto& slot : slots) {
        choices.slots.push_back({slot.duration_s()});
        if (slot.fixed) choices.slots.back().fixed = index_of(planner, *slot.fixed).value();
    }
    return choices;
}

/// Returns whether a choice of least power charges the battery at any time.
bool charges(const SlotDynamics& dynamics) {
    constexpr double rounding_of_power_w = 1e-6;  // as refuse_charging has it
    const double min_compute_w = std::ranges::min(dynamics.compute_w);
    return std::ranges::any_of(
        dynamics.slots, [&](const auto& slot) { return slot.min_mechanical_w + min_compute_w < -rounding_of_power_w; });
}

Schedule schedule_of(const PlanningTables& planner, const std::vector<MissionSlot>& slots,
                     const std::vector<std::size_t>& choices) {
    Schedule schedule;
    for (std::size_t i = 0; i < slots.size(); ++i)
        append_merged(schedule, {slots[i], planner.configurations[choices[i]]});
    return schedule;
}

}  // namespace

compute::Configuration min_power_configuration(const PlanningProblem& problem) {
    require_few(problem);
    const auto choices = every_choice(problem);
    return std::ranges::min_element(choices, draws_less)->run;
}

PlanningTables make_planning_tables(const PlanningProblem& problem) {
    if (!has_utility(problem.setup)) {
        throw InputError({problem.setup.file}, "the mission states no utility",
                         "give a component utility = { parameter = ..., weight = ... }");
    }
    require_few(problem);
    const auto fixed = configurations_of(problem.fixed);
    const auto kept = problem.plan.dwell_s > 0.0 ? fixed : std::vector<compute::Configuration>();
    PlanningTables planner;
    auto& configurations = planner.configurations;
    for (auto& choice : undominated(every_choice(problem), kept)) {
        configurations.push_back(std::move(choice.run));
        planner.utility_per_s.push_back(choice.utility_per_s);
    }
    planner.free_choices = configurations.size();
    for (const auto& run : fixed) {
        if (index_of(planner, run)) continue;
        configurations.push_back(run);
        planner.utility_per_s.push_back(utility_per_s(problem.setup.utilities, run));
    }
    for (const auto& run : configurations) planner.compute_w.push_back(power_w(problem.setup.compute, run));
    return planner;
}

std::vector<MissionSlot> make_slots(const PlanningProblem& problem, double time_s) {
    const auto timeline = timeline_of(problem.setup.duration_s);
    require_few_slots(problem, timeline.duration_s);
    std::vector<MissionSlot> slots;
    for (const auto phase : all_phases) {
        const double duration_s = problem.setup.duration_s[phase];
        const double tolerance_s = same_time_tolerance_s(duration_s);
        double covered_s = std::max(0.0, time_s - timeline.start_s[phase]);
        const auto fill_until = [&](double until_s) {
            add_free_slots({phase, covered_s, until_s}, problem.plan.slot_s * problem.plan.slot_scale[phase],
                           tolerance_s, slots);
        };
        for (const auto& segment : problem.fixed) {
            if (segment.phase != phase || segment.end_s <= covered_s + tolerance_s) continue;
            fill_until(segment.start_s);
            slots.push_back({{phase, std::max(covered_s, segment.start_s), segment.end_s}, segment.run});
            covered_s = segment.end_s;
        }
        fill_until(duration_s);
    }
    return slots;
}

Schedule minimum_energy_schedule(const PlanningProblem& problem) {
    const auto least_power = min_power_configuration(problem);
    Schedule schedule;
    for (const auto& slot : make_slots(problem)) append_merged(schedule, {slot, slot.fixed.value_or(least_power)});
    return schedule;
}

Mission with_minimum_energy_schedule(const MissionVariant& mission) {
    if (const auto* problem = std::get_if<PlanningProblem>(&mission))
        return {problem->setup, minimum_energy_schedule(*problem)};
    return std::get<Mission>(mission);
}

Plan plan_remaining(const PlanningProblem& problem, const PlanningTables& planner, const PlanStart& start,
                    double reserve_soc_percent, const SearchLimits& limits) {
    constexpr double rounding_percent = 3e-6;  // of slot_dynamics.h against the simulation
    const auto slots = make_slots(problem, start.time_s);
    const auto choices = choices_of(problem, planner, start, slots);
    const auto dynamics =
        make_slot_dynamics(problem.setup, {slots.begin(), slots.end()}, planner.compute_w, start.mechanical_factor);
    const auto chosen = search_schedule(
        {dynamics, choices, {start.soc_percent, start.rc_voltage_v}, reserve_soc_percent - rounding_percent}, limits);
    Plan plan;
    plan.feasible = chosen.feasible;
    plan.bound_is_proven = !charges(dynamics);
    plan.schedule = schedule_of(planner, slots, chosen.best.choices);
    plan.final_soc_percent = chosen.best.end_percent;
    double duration_s = 0.0;
    for (const auto& slot : slots) duration_s += slot.duration_s();
    if (duration_s > 0.0) {
        plan.utility = chosen.best.utility / duration_s;
        plan.utility_bound = chosen.bound / duration_s;
    }
    return plan;
}

}  // namespace flightwatt::mission
