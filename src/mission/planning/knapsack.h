#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A time in which one choice runs throughout.
struct ChoiceSlot {
    double duration_s = 0.0;
    std::optional<std::size_t> fixed;  ///< the choice is made
    std::vector<double> drain;         ///< of every choice, in the unit of the budget; infinite: impossible
};

/// What runs already as the first slot begins.
struct RunningChoice {
    std::size_t choice = 0;
    double since_s = 0.0;
};

/// One choice a slot, so that they are worth most and drain no more than the budget: a multiple-choice
/// knapsack. Whoever changes the choice stays with it for `dwell_s`, or for the whole time between two fixed
/// slots if that is shorter. A run that contains a fixed slot is as long as it likes; the end of the last
/// slot does not excuse a run that began too late.
struct SlotChoiceProblem {
    std::vector<ChoiceSlot> slots;
    std::vector<double> worth_per_s;  ///< of every choice
    std::size_t free_choices = 0;     ///< the first so many may be chosen, the others are only fixed
    double budget = 0.0;
    double dwell_s = 0.0;
    std::optional<RunningChoice> running;
};

struct SlotChoice {
    bool feasible = false;
    std::vector<std::size_t> choices;  ///< one a slot; if infeasible, those that drain least
    double worth = 0.0;                ///< sum of worth_per_s * duration
    double drain = 0.0;
    double bound = 0.0;     ///< proven: nothing within the budget is worth more
    bool possible = false;  ///< some choice does not drain an infinite amount
};

/// How far to search.
struct SlotChoiceEffort {
    double relative_gap = 1e-6;       ///< between worth and bound, at which the search ends
    std::size_t most_labels = 20000;  ///< kept a slot; if more are needed, the bound says what that may cost
};

/// Lagrangian relaxation finds the slope of worth over drain and a bound; labels (drain, worth) are then
/// carried from slot to slot, without those that another one dominates or whose own bound says that they
/// cannot win. What is dropped for want of room raises the bound, so that it holds in any case.
SlotChoice choose_slots(const SlotChoiceProblem& problem, const SlotChoiceEffort& effort = {});

}  // namespace flightwatt::mission
