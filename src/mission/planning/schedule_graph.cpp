#include "mission/planning/schedule_graph.h"

namespace flightwatt::mission {
namespace {

constexpr double same_duration_s = 1e-6;

std::size_t gap_end(const std::vector<ChoiceSlot>& slots, std::size_t i) {
    while (i < slots.size() && !slots[i].fixed) ++i;
    return i;
}

bool begins_gap(const std::vector<ChoiceSlot>& slots, std::size_t i) { return i == 0 || slots[i - 1].fixed; }

/// Adds the shortest run of `choice` from slot `from` that lasts for the dwell time, if there is one.
void add_run(const ScheduleChoices& problem, std::size_t from, std::size_t choice, std::vector<ChoiceRun>& runs) {
    const auto& slots = problem.slots;
    const auto end = gap_end(slots, from);
    ChoiceRun run{choice, from};
    double lasts_s = 0.0;
    do {
        lasts_s += slots[run.to++].duration_s;
    } while (lasts_s < problem.dwell_s - same_duration_s && run.to < end);
    run.utility = problem.utility_per_s[choice] * lasts_s;
    const bool lasts = lasts_s >= problem.dwell_s - same_duration_s;
    const bool continues = end < slots.size() && slots[end].fixed == choice;
    if (lasts || continues || begins_gap(slots, from)) runs.push_back(run);
}

/// Returns the run of one slot.
ChoiceRun single(const ScheduleChoices& problem, std::size_t slot, std::size_t choice, bool continues = false) {
    return {choice, slot + 1, problem.utility_per_s[choice] * problem.slots[slot].duration_s, continues};
}

/// Begins the graph where the dwell time of the running choice is over.
void commit_running(const ScheduleChoices& problem, ScheduleGraph& graph) {
    if (!problem.running || problem.slots.empty() || problem.slots[0].fixed) return;
    graph.begin_choice = problem.running->choice;
    const auto end = gap_end(problem.slots, 0);
    double lasts_s = problem.running->since_s;
    while (graph.begin < end && lasts_s < problem.dwell_s - same_duration_s) {
        lasts_s += problem.slots[graph.begin].duration_s;
        graph.utility_before_begin += single(problem, graph.begin, graph.begin_choice).utility;
        ++graph.begin;
    }
}

}  // namespace

ScheduleGraph make_schedule_graph(const ScheduleChoices& problem) {
    ScheduleGraph graph;
    graph.slots = problem.slots.size();
    graph.choices = problem.utility_per_s.size();
    graph.runs.resize(graph.slots);
    for (std::size_t i = 0; i < graph.slots; ++i) {
        if (const auto& fixed = problem.slots[i].fixed) {
            graph.runs[i].push_back(single(problem, i, *fixed));
            continue;
        }
        for (std::size_t c = 0; c < problem.free_choices; ++c) {
            add_run(problem, i, c, graph.runs[i]);
            const bool is_single =
                !graph.runs[i].empty() && graph.runs[i].back().choice == c && graph.runs[i].back().to == i + 1;
            if (!is_single) graph.runs[i].push_back(single(problem, i, c, true));
        }
    }
    commit_running(problem, graph);
    return graph;
}

std::vector<std::size_t> least_choices(const ScheduleChoices& problem, const ScheduleGraph& graph,
                                       const std::vector<double>& compute_w) {
    std::vector<std::size_t> choices(graph.begin, graph.begin_choice);
    for (std::size_t i = graph.begin; i < graph.slots; ++i) {
        const bool is_fixed = problem.slots[i].fixed.has_value();
        if (!is_fixed && i > graph.begin && !begins_gap(problem.slots, i)) {
            choices.push_back(choices.back());
            continue;
        }
        std::optional<std::size_t> least;
        const auto consider = [&](std::size_t choice) {
            if (!least || compute_w[choice] < compute_w[*least]) least = choice;
        };
        for (const auto& run : graph.runs[i])
            if (!run.continues) consider(run.choice);
        const bool may_continue = i == graph.begin && !is_fixed && graph.begin_choice != ScheduleGraph::no_choice;
        if (may_continue && (!least || graph.begin_choice < problem.free_choices)) consider(graph.begin_choice);
        choices.push_back(least.value());
    }
    return choices;
}

double utility_of(const ScheduleChoices& problem, const std::vector<std::size_t>& choices) {
    double utility = 0.0;
    for (std::size_t i = 0; i < choices.size(); ++i)
        utility += problem.utility_per_s[choices[i]] * problem.slots[i].duration_s;
    return utility;
}

}  // namespace flightwatt::mission
