#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A time in which one choice runs throughout.
struct KnapsackSlot {
    double duration_s = 0.0;
    std::optional<std::size_t> fixed;  ///< the choice is made
    std::vector<double> cost;          ///< of every choice, in the unit of the budget; infinite: impossible
};

/// What runs already as the first slot starts.
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
    std::size_t free_choices = 0;       ///< the first so many may be chosen, the others are only fixed
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
    std::size_t max_labels = 20000;  ///< kept a slot; if more are needed, the bound says what that may cost
    std::size_t value_cells = 96;    ///< of the bound over charge, where the battery's state counts (schedule_value.h)
};

/// Lagrangian relaxation finds the slope of utility over cost and a bound; labels (cost, utility) are then
/// carried from slot to slot, without those that another one dominates or whose own bound says that they
/// cannot win. What is dropped for want of room raises the bound, so that it holds in any case.
KnapsackSolution solve_knapsack(const MultipleChoiceKnapsack& problem, const SearchLimits& effort = {});

}  // namespace flightwatt::mission
