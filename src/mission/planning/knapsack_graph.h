#pragma once

#include "mission/planning/knapsack.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace flightwatt::mission {

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

/// The choices as a graph: between two slots stands a choice that has been on for long enough to end. From
/// there either a run begins that lasts as long as it must, or the same choice goes on for one slot more.
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
    std::vector<std::vector<double>> with;  ///< the same while a choice runs that may go on
};

CostToGo cost_to_go(const KnapsackGraph& graph, double utility_weight, double cost_weight);

/// A way through all slots.
struct KnapsackPath {
    std::vector<std::size_t> choices;
    CostAndUtility sum;
};

/// A way that reaches `to_go`, which must be that of the same weights and finite.
KnapsackPath best_path(const KnapsackGraph& graph, const CostToGo& to_go, double utility_weight, double cost_weight);

}  // namespace flightwatt::mission
