#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A time in which one choice runs throughout.
struct KnapsackSlot {
    double duration_s = 0.0;
    std::optional<std::size_t> fixed;  ///< the choice is made
    std::vector<double> cost;          ///< of every choice, in the unit of the budget; infinite: impossible
};

/// The choice that is running when the first slot starts.
struct RunningChoice {
    std::size_t choice = 0;
    double since_s = 0.0;
};

/// One choice a slot, of most utility and with costs within the budget: a multiple-choice knapsack. After a change the
/// new choice is kept for at least `dwell_s`, or until the next fixed slot if that is sooner. A run that contains a
/// fixed slot may be of any length; the end of the last slot does not excuse a run that started too late.
struct MultipleChoiceKnapsack {
    std::vector<KnapsackSlot> slots;
    std::vector<double> utility_per_s;  ///< of every choice
    std::size_t free_choices = 0;       ///< number of leading choices that may be chosen; the others are only fixed
    double budget = 0.0;
    double dwell_s = 0.0;
    std::optional<RunningChoice> running;
};

struct KnapsackSolution {
    bool feasible = false;
    std::vector<std::size_t> choices;  ///< one a slot; if infeasible, those of least cost
    double utility = 0.0;              ///< sum of utility_per_s * duration
    double cost = 0.0;
    double bound = 0.0;     ///< proven: nothing within the budget has more utility
    bool possible = false;  ///< some choice has no infinite cost
};

/// How far to search.
struct SearchLimits {
    double relative_gap = 1e-6;      ///< between utility and bound, at which the search ends
    std::size_t max_labels = 20000;  ///< per slot; dropping more of them raises the bound
    std::size_t value_cells = 96;    ///< of the bound over charge, where the battery's state counts (schedule_value.h)
};

/// Lagrangian relaxation gives a bound and a slope of utility over cost; a label search over (cost, utility) then drops
/// labels that are dominated or cannot exceed the best by their bound. Labels dropped to limit their number raise the
/// bound.
KnapsackSolution solve_knapsack(const MultipleChoiceKnapsack& problem, const SearchLimits& effort = {});

/// The sums of a part of a sequence of slots.
struct CostAndUtility {
    double cost = 0.0;
    double utility = 0.0;
};

/// Running a choice from one slot to before another.
struct ChoiceRun {
    std::size_t choice = 0;
    std::size_t to = 0;
    CostAndUtility sum;
};

/// The choices as a graph: at a node between two slots, a choice has run for long enough to end. From there either a
/// run of minimum duration begins, or the same choice continues for one slot.
struct KnapsackGraph {
    std::size_t slots = 0;
    std::size_t choices = 0;
    std::vector<std::vector<ChoiceRun>> runs;      ///< that may begin with a slot
    std::vector<std::vector<ChoiceRun>> one_more;  ///< the slot alone; only where a new run is longer
    std::size_t begin = 0;                         ///< the first slot that is not committed already
    std::size_t begin_choice = no_choice;          ///< what runs then
    CostAndUtility before_begin;                   ///< of the slots that are committed
    bool possible = true;
    static constexpr std::size_t no_choice = std::numeric_limits<std::size_t>::max();
};

KnapsackGraph make_knapsack_graph(const MultipleChoiceKnapsack& problem);

/// The best that can follow: the greatest of utility_weight * utility - cost_weight * cost over the rest.
struct CostToGo {
    std::vector<double> any;                ///< at each slot, free to begin a run
    std::vector<std::vector<double>> with;  ///< the same while a choice runs that may continue
};

CostToGo cost_to_go(const KnapsackGraph& graph, double utility_weight, double cost_weight);

/// A part of a schedule that ends with a run; `before` is the index of the previous run in the trail.
struct RunStep {
    std::size_t before = 0;
    std::size_t choice = 0;
    std::size_t to = 0;
};

/// Puts the labels' last runs into the trail: only those that survived, for it grows with every slot.
template <typename Label>
void leave_trail(std::vector<Label>& labels, std::vector<RunStep>& trail) {
    for (auto& label : labels) {
        trail.push_back(label);
        label.before = trail.size() - 1;
    }
}

/// The choices that lead to the end of a run.
std::vector<std::size_t> choices_until(RunStep last, const std::vector<RunStep>& trail, const KnapsackGraph& graph);

/// A way through all slots.
struct KnapsackPath {
    std::vector<std::size_t> choices;
    CostAndUtility sum;
};

/// A way that reaches `to_go`, which must be that of the same weights and finite.
KnapsackPath best_path(const KnapsackGraph& graph, const CostToGo& to_go, double utility_weight, double cost_weight);

}  // namespace flightwatt::mission
