#include "mission/planning/schedule_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

namespace flightwatt::mission {
namespace {

constexpr double no_bound = -std::numeric_limits<double>::infinity();

/// A part of a schedule that ends with a run; `before` is the index of the previous run in the trail.
struct RunStep {
    std::size_t before = 0;
    std::size_t choice = 0;
    std::size_t to = 0;
};

/// A schedule of the first slots, by its last run, and where it leads to.
struct State : RunStep {
    battery::BatteryState battery;
    double utility = 0.0;
    double adjusted_percent = 0.0;  ///< the charge less what the RC voltage costs at least
    double bound = 0.0;             ///< no schedule that begins so and lands has more utility
};

/// One pass from the first slot to the last.
struct SearchPass {
    const ScheduleProblem& problem;
    const ScheduleGraph& graph;
    const UtilityBound& bound;
    std::size_t max_states = 0;
    double negligible = 0.0;    ///< utility that does not count, in one slot
    double enough = 0.0;        ///< utility beyond which a state is kept
    double dropped = no_bound;  ///< bound of all states that are not kept
    std::vector<RunStep> trail = {};
};

/// Sets what depends on the bound of the utility to go.
void set_bound(const UtilityBound& bound, State& state) {
    const auto& [soc_percent, rc_v] = state.battery;
    state.adjusted_percent = soc_percent - bound.rc_min_cost[state.to] * rc_v;
    state.bound = state.utility + utility_to_go(bound, state.to, state.choice, state.battery);
}

/// Removes states that another one dominates, up to a negligible utility. `states` is in order of adjusted charge.
void remove_dominated(const SearchPass& pass, double rc_max_cost, std::vector<State>& states) {
    std::map<double, double> utility_by_key;  // of those kept; utility falls as the key rises
    std::erase_if(states, [&](const State& state) {
        const auto& [soc_percent, rc_v] = state.battery;
        const double key = std::isfinite(rc_max_cost) ? soc_percent - rc_max_cost * rc_v : -rc_v;
        const auto as_good = utility_by_key.lower_bound(key);
        if (as_good != utility_by_key.end() && as_good->second + pass.negligible >= state.utility) return true;
        auto at = utility_by_key.insert_or_assign(key, state.utility).first;
        while (at != utility_by_key.begin() && std::prev(at)->second <= state.utility)
            utility_by_key.erase(std::prev(at));
        return false;
    });
}

/// Keeps the states of greatest bound, and of the others the one of greatest bound in each cell of charge: some that
/// have spent little may be all that land where a cut-off ends the flight late. `states` is in order of charge.
void keep_best(SearchPass& pass, std::vector<State>& states) {
    if (states.size() <= pass.max_states) return;
    const std::size_t cells = pass.max_states / 4;
    const double high_percent = states.front().adjusted_percent;
    const double width_percent = std::max(1e-12, high_percent - states.back().adjusted_percent);
    std::ranges::stable_sort(states, std::greater(), &State::bound);
    std::vector<bool> is_taken(cells + 1);
    std::size_t rank = 0;
    std::erase_if(states, [&](const State& state) {
        const double place = (high_percent - state.adjusted_percent) / width_percent;
        const auto cell = static_cast<std::size_t>(place * static_cast<double>(cells));
        const bool is_kept = rank++ < pass.max_states - cells || !is_taken[cell];
        is_taken[cell] = true;
        if (!is_kept) pass.dropped = std::max(pass.dropped, state.bound);
        return !is_kept;
    });
}

/// Removes the states that need not be followed, and appends the last runs of the others to the trail.
void prune(SearchPass& pass, std::size_t slot, std::vector<State>& states) {
    // Stable: the order of equal states, and with it the schedule, is that of every standard library.
    std::ranges::stable_sort(states, [](const State& a, const State& b) {
        return a.adjusted_percent != b.adjusted_percent ? a.adjusted_percent > b.adjusted_percent
                                                        : a.utility > b.utility;
    });
    remove_dominated(pass, pass.bound.rc_max_cost[slot], states);
    keep_best(pass, states);
    for (auto& state : states) {
        pass.trail.push_back(state);
        state.before = pass.trail.size() - 1;
    }
}

/// Appends the states after a run.
void follow_run(SearchPass& pass, std::size_t slot, const ChoiceRun& run, const std::vector<State>& states,
                std::vector<State>& to) {
    for (const auto& state : states) {
        const auto after = advance_run(pass.problem.dynamics, slot, run.to, run.choice, state.battery);
        if (!after) continue;
        State next{{state.before, run.choice, run.to}, *after, state.utility + run.utility};
        set_bound(pass.bound, next);
        if (next.bound > pass.enough)
            to.push_back(next);
        else
            pass.dropped = std::max(pass.dropped, next.bound);
    }
}

/// Returns the choices that lead to the end of a run.
std::vector<std::size_t> choices_until(const SearchPass& pass, RunStep last) {
    std::vector<std::size_t> choices(pass.graph.slots, pass.graph.begin_choice);
    while (last.to > pass.graph.begin) {
        const auto& before = pass.trail[last.before];
        for (std::size_t i = before.to; i < last.to; ++i) choices[i] = last.choice;
        last = before;
    }
    return choices;
}

/// Replaces `best` by a better schedule, if one is found. Returns an upper bound of the utility.
double run_pass(SearchPass& pass, const State& first, FoundSchedule& best) {
    const auto& graph = pass.graph;
    std::vector<std::vector<std::vector<State>>> at(graph.slots + 1,
                                                    std::vector<std::vector<State>>(graph.choices + 1));
    at[graph.begin][std::min(graph.begin_choice, graph.choices)] = {first};
    pass.trail = {first};
    for (std::size_t i = graph.begin; i < graph.slots; ++i) {
        std::vector<State> free;
        for (const auto& states : at[i]) free.insert(free.end(), states.begin(), states.end());
        prune(pass, i, free);
        for (const auto& run : graph.runs[i]) {
            if (run.continues) prune(pass, i, at[i][run.choice]);
            follow_run(pass, i, run, run.continues ? at[i][run.choice] : free, at[run.to][run.choice]);
        }
        at[i].clear();
    }
    for (const auto& states : at[graph.slots])
        for (const auto& state : states)
            if (state.utility > best.utility)
                best = {choices_until(pass, state), state.utility, state.battery.soc_percent};
    return std::max(best.utility, pass.dropped) + pass.negligible * static_cast<double>(2 * graph.slots);
}

/// Returns the schedule of least energy demand, and where it ends.
FoundSchedule least_schedule(const ScheduleProblem& problem, const ScheduleGraph& graph) {
    FoundSchedule least{least_choices(problem.choices, graph, problem.dynamics.compute_w)};
    least.utility = utility_of(problem.choices, least.choices);
    auto battery = problem.start;
    for (std::size_t i = 0; i < graph.slots; ++i) {
        const auto after = advance_slot(problem.dynamics, i, least.choices[i], battery);
        if (!after || after->soc_percent < 0.0) return least;
        battery = *after;
    }
    least.end_percent = battery.soc_percent;
    return least;
}

/// Returns as much of the limits as time and memory allow for many slots, choices or long runs.
SearchLimits affordable(SearchLimits limits, const ScheduleGraph& graph) {
    constexpr std::size_t max_cells_made = 2000000;
    constexpr std::size_t max_states_made = 6000000;
    std::size_t work = 1;
    for (std::size_t i = 0; i < graph.slots; ++i)
        for (const auto& run : graph.runs[i]) work += run.to - i;
    limits.bound_cells = std::min(limits.bound_cells, std::max<std::size_t>(8, max_cells_made / work));
    limits.max_states = std::min(limits.max_states, std::max<std::size_t>(50, max_states_made / work));
    return limits;
}

}  // namespace

SearchResult search_schedule(const ScheduleProblem& problem, const SearchLimits& wanted) {
    constexpr std::size_t states_at_first = 100;
    constexpr std::size_t times_more = 4;
    constexpr double part_for_rounding = 1e-3;
    const auto graph = make_schedule_graph(problem.choices);
    const auto limits = affordable(wanted, graph);
    SearchResult result{false, least_schedule(problem, graph)};
    result.feasible = result.best.end_percent >= problem.reserve_soc_percent;
    if (!result.feasible) return result;
    const auto begun = advance_run(problem.dynamics, 0, graph.begin, graph.begin_choice, problem.start);
    State first{{0, graph.begin_choice, graph.begin}, begun.value(), graph.utility_before_begin};
    auto bound = make_utility_bound(problem, graph, limits.bound_cells);
    set_bound(bound, first);
    result.bound = std::max(first.bound, result.best.utility);
    const double gap = limits.relative_gap * std::max(std::abs(result.bound), 1e-9);
    for (auto states = std::min(states_at_first, limits.max_states); result.bound - result.best.utility > gap;) {
        SearchPass pass{problem, graph, bound, std::min(states, limits.max_states)};
        pass.negligible = part_for_rounding * gap / static_cast<double>(2 * graph.slots);
        pass.enough = result.best.utility + gap / 2.0;
        set_bound(bound, first);
        result.bound = std::max(std::min(result.bound, run_pass(pass, first, result.best)), result.best.utility);
        if (states >= limits.max_states) break;
        states *= times_more;
        bound = make_utility_bound(problem, graph, limits.bound_cells, result.best.choices);
    }
    return result;
}

}  // namespace flightwatt::mission
