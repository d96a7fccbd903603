#include "mission/planning/knapsack_graph.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flightwatt::mission {
namespace {

constexpr double same_duration_s = 1e-6;

std::size_t gap_end(const std::vector<KnapsackSlot>& slots, std::size_t i) {
    while (i < slots.size() && !slots[i].fixed) ++i;
    return i;
}

bool begins_gap(const std::vector<KnapsackSlot>& slots, std::size_t i) { return i == 0 || slots[i - 1].fixed; }

/// Adds the run of `choice` from slot `from` for at least so long, if it can be.
void add_run(const MultipleChoiceKnapsack& problem, std::size_t from, std::size_t choice,
             std::vector<ChoiceRun>& runs) {
    const auto& slots = problem.slots;
    const auto end = gap_end(slots, from);
    ChoiceRun run{choice, from, {}};
    double lasts_s = 0.0;
    do {
        const auto& slot = slots[run.to++];
        lasts_s += slot.duration_s;
        run.sum.cost += slot.cost[choice];
        run.sum.utility += problem.utility_per_s[choice] * slot.duration_s;
    } while (lasts_s < problem.dwell_s - same_duration_s && run.to < end);
    const bool lasts = lasts_s >= problem.dwell_s - same_duration_s;
    const bool goes_on = end < slots.size() && slots[end].fixed == choice;
    if (!lasts && !goes_on && !begins_gap(slots, from)) return;
    if (std::isfinite(run.sum.cost)) runs.push_back(run);
}

/// One slot of `choice`.
ChoiceRun single(const MultipleChoiceKnapsack& problem, std::size_t slot, std::size_t choice) {
    const auto& s = problem.slots[slot];
    return {choice, slot + 1, {s.cost[choice], problem.utility_per_s[choice] * s.duration_s}};
}

/// What runs already goes on until it has lasted.
void commit_running(const MultipleChoiceKnapsack& problem, KnapsackGraph& graph) {
    if (!problem.running || problem.slots.empty() || problem.slots[0].fixed) return;
    graph.begin_choice = problem.running->choice;
    const auto end = gap_end(problem.slots, 0);
    double lasts_s = problem.running->since_s;
    while (graph.begin < end && lasts_s < problem.dwell_s - same_duration_s) {
        const auto run = single(problem, graph.begin, graph.begin_choice);
        lasts_s += problem.slots[graph.begin].duration_s;
        graph.before_begin.cost += run.sum.cost;
        graph.before_begin.utility += run.sum.utility;
        graph.begin = run.to;
    }
    graph.possible = std::isfinite(graph.before_begin.cost);
}

double value(const CostAndUtility& sum, double utility_weight, double cost_weight) {
    return utility_weight * sum.utility - cost_weight * sum.cost;
}

}  // namespace

KnapsackGraph make_knapsack_graph(const MultipleChoiceKnapsack& problem) {
    KnapsackGraph graph;
    graph.slots = problem.slots.size();
    graph.choices = problem.utility_per_s.size();
    graph.runs.resize(graph.slots);
    graph.one_more.resize(graph.slots);
    for (std::size_t i = 0; i < graph.slots; ++i) {
        const auto& slot = problem.slots[i];
        if (slot.fixed) {
            const auto run = single(problem, i, *slot.fixed);
            if (std::isfinite(run.sum.cost)) graph.runs[i].push_back(run);
            continue;
        }
        for (std::size_t c = 0; c < problem.free_choices; ++c) {
            add_run(problem, i, c, graph.runs[i]);
            const auto run = single(problem, i, c);
            const bool is_run =
                !graph.runs[i].empty() && graph.runs[i].back().choice == c && graph.runs[i].back().to == i + 1;
            if (!is_run && std::isfinite(run.sum.cost)) graph.one_more[i].push_back(run);
        }
    }
    commit_running(problem, graph);
    return graph;
}

CostToGo cost_to_go(const KnapsackGraph& graph, double utility_weight, double cost_weight) {
    constexpr double never = -std::numeric_limits<double>::infinity();
    CostToGo best{std::vector<double>(graph.slots + 1, never), {}};
    best.with.assign(graph.slots + 1, std::vector<double>(graph.choices, never));
    best.any.back() = 0.0;
    best.with.back().assign(graph.choices, 0.0);
    for (std::size_t i = graph.slots; i-- > 0;) {
        for (const auto& run : graph.runs[i]) {
            const double then = value(run.sum, utility_weight, cost_weight) + best.with[run.to][run.choice];
            best.any[i] = std::max(best.any[i], then);
        }
        best.with[i].assign(graph.choices, best.any[i]);
        for (const auto& run : graph.one_more[i]) {
            const double then = value(run.sum, utility_weight, cost_weight) + best.with[run.to][run.choice];
            best.with[i][run.choice] = std::max(best.with[i][run.choice], then);
        }
    }
    return best;
}

KnapsackPath best_path(const KnapsackGraph& graph, const CostToGo& to_go, double utility_weight, double cost_weight) {
    KnapsackPath path;
    path.sum = graph.before_begin;
    path.choices.assign(graph.begin, graph.begin_choice);
    std::size_t choice = graph.begin_choice;
    for (std::size_t i = graph.begin; i < graph.slots;) {
        const ChoiceRun* next = nullptr;
        double most = -std::numeric_limits<double>::infinity();
        const auto consider = [&](const ChoiceRun& run) {
            const double then = value(run.sum, utility_weight, cost_weight) + to_go.with[run.to][run.choice];
            if (next == nullptr || then > most) {
                most = then;
                next = &run;
            }
        };
        for (const auto& run : graph.runs[i]) consider(run);
        for (const auto& run : graph.one_more[i])
            if (run.choice == choice) consider(run);
        if (next == nullptr) throw std::logic_error("best_path: there is no way");
        path.choices.resize(next->to, next->choice);
        path.sum.cost += next->sum.cost;
        path.sum.utility += next->sum.utility;
        choice = next->choice;
        i = next->to;
    }
    return path;
}

}  // namespace flightwatt::mission
