#pragma once

#include "mission/planning/knapsack.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace flightwatt::mission {

/// What a part of a sequence of slots drains and is worth.
struct DrainAndWorth {
    double drain = 0.0;
    double worth = 0.0;
};

/// Running a choice from one slot to before another.
struct SlotRun {
    std::size_t choice = 0;
    std::size_t to = 0;
    DrainAndWorth sum;
};

/// The choices as a graph: between two slots stands a choice that has been on for long enough to end. From
/// there either a run begins that lasts as long as it must, or the same choice goes on for one slot more.
struct SlotGraph {
    std::size_t slots = 0;
    std::size_t choices = 0;
    std::vector<std::vector<SlotRun>> runs;      ///< that may begin with a slot
    std::vector<std::vector<SlotRun>> one_more;  ///< the slot alone; only where a new run is longer
    std::size_t begin = 0;                       ///< the first slot that is not committed already
    std::size_t begin_choice = no_choice;        ///< what runs then
    DrainAndWorth before_begin;                  ///< of the slots that are committed
    bool possible = true;
    static constexpr std::size_t no_choice = std::numeric_limits<std::size_t>::max();
};

SlotGraph make_slot_graph(const SlotChoiceProblem& problem);

/// The best that can follow: the greatest of worth_weight * worth - drain_weight * drain over the rest.
struct Prospects {
    std::vector<double> any;                ///< at each slot, free to begin a run
    std::vector<std::vector<double>> with;  ///< the same while a choice runs that may go on
};

Prospects prospects_of(const SlotGraph& graph, double worth_weight, double drain_weight);

/// A way through all slots.
struct SlotPath {
    std::vector<std::size_t> choices;
    DrainAndWorth sum;
};

/// A way that reaches the prospects, which must be those of the same weights and finite.
SlotPath best_path(const SlotGraph& graph, const Prospects& prospects, double worth_weight,
                   double drain_weight);

}  // namespace flightwatt::mission
