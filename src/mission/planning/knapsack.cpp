#include "mission/planning/knapsack.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flightwatt::mission {
namespace {

/// A path through the first slots, by its last run and its sums.
struct Label : RunStep {
    CostAndUtility sum;
};

/// The best solution found, and bounds.
struct Search {
    const KnapsackGraph& graph;
    double budget = 0.0;
    double slope = 0.0;  ///< utility a unit of cost, of the relaxation
    CostToGo by_slope;
    CostToGo by_cost;  ///< minus the least cost to the end
    KnapsackPath best;
    KnapsackPath beyond;  ///< as good by the slope, and over the budget
    double bound = 0.0;   ///< of the relaxation, or better
};

/// Rounding in sums of costs.
double slack(double budget) { return 1e-12 * std::max(1.0, std::abs(budget)); }

/// One pass from the first slot to the last with a limited number of labels.
class LabelPass {
  public:
    LabelPass(const Search& search, std::size_t max_labels, double utility_gap)
        : search_(search), max_labels_(max_labels), utility_gap_(utility_gap) {
        // Half of the gap for nearly dominated labels, in two prunings a slot; half for bounds.
        as_good_ = utility_gap / 2.0 / static_cast<double>(2 * search.graph.slots + 2);
        dropped_bound_ = search.best.sum.utility;
    }

    /// Carries labels through all slots. The search's best and bound are better afterwards, or as good.
    void run(Search& result) {
        const auto& graph = search_.graph;
        std::vector<std::vector<std::vector<Label>>> at(graph.slots + 1);
        for (auto& labels : at) labels.resize(graph.choices + 1);
        trail_.push_back({0, graph.begin_choice, graph.begin});
        at[graph.begin][std::min(graph.begin_choice, graph.choices)].push_back({trail_.front(), graph.before_begin});
        for (std::size_t i = graph.begin; i < graph.slots; ++i) {
            expand(i, at);
            at[i].clear();
        }
        const auto finished = merged(graph.slots, at[graph.slots]);
        const auto best = std::ranges::max_element(
            finished, [](const auto& a, const auto& b) { return a.sum.utility < b.sum.utility; });
        if (best != finished.end() && best->sum.utility > result.best.sum.utility)
            result.best = {choices_until(*best, trail_, graph), best->sum};
        const double lost = as_good_ * static_cast<double>(2 * graph.slots + 2);
        result.bound = std::min(result.bound, std::max(result.best.sum.utility, dropped_bound_) + lost);
        result.bound = std::max(result.bound, result.best.sum.utility);
    }

  private:
    using Layer = std::vector<std::vector<Label>>;

    std::vector<Label> merged(std::size_t i, const Layer& layer) {
        std::vector<Label> all;
        for (const auto& labels : layer) all.insert(all.end(), labels.begin(), labels.end());
        prune(all, search_.by_slope.any[i], search_.by_cost.any[i]);
        return all;
    }

    void expand(std::size_t i, std::vector<Layer>& at) {
        const auto& graph = search_.graph;
        auto free = merged(i, at[i]);
        leave_trail(free, trail_);
        for (const auto& run : graph.runs[i]) carry(free, run, at[run.to][run.choice]);
        for (const auto& run : graph.one_more[i]) {
            auto& own = at[i][run.choice];
            prune(own, search_.by_slope.with[i][run.choice], search_.by_cost.with[i][run.choice]);
            leave_trail(own, trail_);
            carry(own, run, at[run.to][run.choice]);
        }
    }

    void carry(const std::vector<Label>& labels, const ChoiceRun& run, std::vector<Label>& to) {
        for (const auto& label : labels) {
            to.push_back({{label.before, run.choice, run.to},
                          {label.sum.cost + run.sum.cost, label.sum.utility + run.sum.utility}});
        }
    }

    /// No way on from `label` has more utility.
    double bound_of(const Label& label, double utility_to_go) const {
        return label.sum.utility + utility_to_go + search_.slope * (search_.budget - label.sum.cost);
    }

    /// Removes labels that are nearly dominated or cannot win. `utility_to_go` bounds the utility of the remaining
    /// slots by slope, `minus_cost` is minus their least cost.
    void prune(std::vector<Label>& labels, double utility_to_go, double minus_cost) {
        const double max_cost = search_.budget + minus_cost + slack(search_.budget);
        std::erase_if(labels, [&](const Label& label) {
            if (!(label.sum.cost <= max_cost)) return true;
            return drop_if(label, utility_to_go, search_.best.sum.utility + utility_gap_ / 2.0);
        });
        std::ranges::sort(labels, [](const Label& a, const Label& b) {
            return a.sum.cost != b.sum.cost ? a.sum.cost < b.sum.cost : a.sum.utility > b.sum.utility;
        });
        double max_utility = -std::numeric_limits<double>::infinity();
        std::erase_if(labels, [&](const Label& label) {
            if (label.sum.utility <= max_utility + as_good_) return true;
            max_utility = label.sum.utility;
            return false;
        });
        if (labels.size() <= max_labels_) return;
        const auto last = labels.begin() + static_cast<std::ptrdiff_t>(max_labels_);
        std::nth_element(labels.begin(), last, labels.end(), [&](const Label& a, const Label& b) {
            return bound_of(a, utility_to_go) > bound_of(b, utility_to_go);
        });
        dropped_bound_ = std::max(dropped_bound_, bound_of(*last, utility_to_go));
        labels.erase(last, labels.end());
    }

    bool drop_if(const Label& label, double utility_to_go, double no_more_than) {
        const double bound = bound_of(label, utility_to_go);
        if (bound > no_more_than) return false;
        dropped_bound_ = std::max(dropped_bound_, bound);
        return true;
    }

    const Search& search_;
    std::size_t max_labels_;
    double utility_gap_;
    double as_good_ = 0.0;
    double dropped_bound_ = 0.0;
    std::vector<RunStep> trail_;
};

KnapsackPath path_by(const KnapsackGraph& graph, double utility_weight, double cost_weight) {
    return best_path(graph, cost_to_go(graph, utility_weight, cost_weight), utility_weight, cost_weight);
}

/// Minimizes the bound of the relaxation over its slope: that of the line through a path within the budget and one
/// beyond it, until no path is above that line.
void relax(const KnapsackPath& greedy, Search& search) {
    auto& beyond = search.beyond;
    beyond = greedy;
    for (int round = 0; round < 100; ++round) {
        search.slope =
            std::max(0.0, (beyond.sum.utility - search.best.sum.utility) / (beyond.sum.cost - search.best.sum.cost));
        search.by_slope = cost_to_go(search.graph, 1.0, search.slope);
        const auto path = best_path(search.graph, search.by_slope, 1.0, search.slope);
        const auto above = [&](const KnapsackPath& p) { return p.sum.utility - search.slope * p.sum.cost; };
        search.bound = std::min(search.bound, above(path) + search.slope * search.budget);
        if (above(path) <= above(beyond) + 1e-12 * (1.0 + std::abs(above(beyond)))) return;
        (path.sum.cost <= search.budget ? search.best : beyond) = path;
    }
}

/// Tries the paths that begin as one of the two and end as the other. Where all slots are equal, all of these have the
/// same bound, and are more than labels hold. Returns whether one improves the best.
bool cross(const MultipleChoiceKnapsack& problem, Search& search) {
    const auto from = search.best;
    const auto& to = search.beyond;
    bool is_better = false;
    for (const bool from_the_front : {true, false}) {
        auto path = from;
        for (std::size_t k = 0; k < path.choices.size(); ++k) {
            const auto i = from_the_front ? k : path.choices.size() - 1 - k;
            const auto& slot = problem.slots[i];
            const auto before = path.choices[i];
            const auto after = to.choices[i];
            path.choices[i] = after;
            path.sum.cost += slot.cost[after] - slot.cost[before];
            path.sum.utility += (problem.utility_per_s[after] - problem.utility_per_s[before]) * slot.duration_s;
            if (path.sum.cost > search.budget || path.sum.utility <= search.best.sum.utility) continue;
            search.best = path;
            is_better = true;
        }
    }
    return is_better;
}

/// As many labels as the effort allows, and as time and memory do for many slots, choices or long runs.
std::size_t affordable_labels(const KnapsackGraph& graph, const SearchLimits& effort) {
    constexpr std::size_t max_in_all = 4000000;
    constexpr std::size_t fewest = 50;
    std::size_t work = 1;  // labels made of each, over all slots
    for (const auto& runs : graph.runs) work += runs.size();
    for (const auto& runs : graph.one_more) work += runs.size();
    return std::min(effort.max_labels, std::max(fewest, max_in_all / work));
}

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
    const bool continues = end < slots.size() && slots[end].fixed == choice;
    if (!lasts && !continues && !begins_gap(slots, from)) return;
    if (std::isfinite(run.sum.cost)) runs.push_back(run);
}

/// One slot of `choice`.
ChoiceRun single(const MultipleChoiceKnapsack& problem, std::size_t slot, std::size_t choice) {
    const auto& s = problem.slots[slot];
    return {choice, slot + 1, {s.cost[choice], problem.utility_per_s[choice] * s.duration_s}};
}

/// The running choice continues until its dwell time is over.
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

KnapsackSolution solve_knapsack(const MultipleChoiceKnapsack& problem, const SearchLimits& effort) {
    const auto graph = make_knapsack_graph(problem);
    KnapsackSolution result;
    Search search{graph, problem.budget, 0.0, {}, cost_to_go(graph, 0.0, 1.0), {}, {}, 0.0};
    const double least = search.by_cost.any.empty() ? 0.0
                         : graph.begin_choice == KnapsackGraph::no_choice
                             ? search.by_cost.any[graph.begin]
                             : search.by_cost.with[graph.begin][graph.begin_choice];
    result.possible = graph.possible && std::isfinite(least);
    if (!result.possible) return result;
    const auto finish = [&](const KnapsackPath& path, bool feasible, double bound) {
        result.feasible = feasible;
        result.choices = path.choices;
        result.utility = path.sum.utility;
        result.cost = path.sum.cost;
        result.bound = bound;
        return result;
    };
    search.best = best_path(graph, search.by_cost, 0.0, 1.0);
    if (search.best.sum.cost > problem.budget + slack(problem.budget)) return finish(search.best, false, 0.0);
    const auto greedy = path_by(graph, 1.0, 0.0);
    if (greedy.sum.cost <= problem.budget) return finish(greedy, true, greedy.sum.utility);
    search.bound = greedy.sum.utility;
    relax(greedy, search);
    const auto max_labels = affordable_labels(graph, effort);
    for (std::size_t labels = 200;; labels *= 10) {
        const double gap = effort.relative_gap * std::max(std::abs(search.best.sum.utility), 1e-9);
        if (search.bound - search.best.sum.utility <= gap) break;
        LabelPass(search, std::min(labels, max_labels), gap).run(search);
        if (labels >= max_labels) break;
    }
    const double wanted = effort.relative_gap * std::max(std::abs(search.best.sum.utility), 1e-9);
    if (problem.dwell_s == 0.0 && search.bound - search.best.sum.utility > wanted && cross(problem, search))
        LabelPass(search, max_labels, wanted).run(search);
    return finish(search.best, true, search.bound);
}

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

std::vector<std::size_t> choices_until(RunStep last, const std::vector<RunStep>& trail, const KnapsackGraph& graph) {
    std::vector<std::size_t> choices(graph.slots, graph.begin_choice);
    while (last.to > graph.begin) {
        const auto& before = trail[last.before];
        std::fill(choices.begin() + static_cast<std::ptrdiff_t>(before.to),
                  choices.begin() + static_cast<std::ptrdiff_t>(last.to), last.choice);
        last = before;
    }
    return choices;
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
