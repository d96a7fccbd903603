#include "mission/planning/schedule_search.h"

#include "mission/planning/state_labels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace flightwatt::mission {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct FoundSchedule {
    std::vector<std::size_t> choices;
    double utility = -infinite;
    double end_percent = -infinite;
};

/// Where a schedule ends; minus infinity if it does not.
double end_percent(const SlotDynamics& dynamics, const std::vector<std::size_t>& choices, battery::BatteryState state) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto after = advance_slot(dynamics, i, choices[i], state);
        if (!after || after->soc_percent < 0.0) return -infinite;
        state = *after;
    }
    return state.soc_percent;
}

void set_bound(const UtilityBound& value, StateLabel& label) {
    label.charge = effective_charge(value, label.to, label.state);
    label.adjusted_percent = label.state.soc_percent - value.rc_low[label.to] * label.state.rc_voltage_v;
    label.bound = may_land(value, label.to, label.state)
                      ? label.utility + utility_to_go(value, label.to, label.choice, label.charge)
                      : -infinite;
}

/// What becomes of labels for which there is no room.
enum class LabelPruning {
    drop_by_bound,    ///< the least promising are dropped
    drop_by_charge,   ///< the least promising of their charge: where a cut-off comes, bounds know little of it
    drop_by_caution,  ///< those that promise least by a HeuristicValue
    join              ///< those that differ little become one
};

/// One pass from the first slot to the last with at most so many labels at a time.
class StatePass {
  public:
    struct Limits {
        std::size_t max_labels = 0;
        double utility_gap = 0.0;
        LabelPruning crowd = LabelPruning::join;
        const HeuristicValue* caution = nullptr;  ///< of drop_by_caution
    };

    StatePass(const ScheduleProblem& question, const KnapsackGraph& graph, const UtilityBound& value,
              const StateLabel& first, const Limits& limits)
        : question_(question), graph_(graph), value_(value), first_(first), limits_(limits) {
        constexpr double part_for_rounding = 1e-3;
        lost_ = part_for_rounding * limits.utility_gap;
        as_good_ = lost_ / static_cast<double>(2 * graph.slots + 2);  // of two merges a slot
        tolerance_ = limits.utility_gap / static_cast<double>(2 * graph.slots + 2);
        utility_per_percent_ = first.bound / std::max(1e-9, value.spare_percent);
    }

    /// `best` becomes the best schedule found, if that is better. Returns what no schedule has more than.
    double run(FoundSchedule& best) {
        enough_utility_ = best.utility + limits_.utility_gap / 2.0;
        std::vector<Layer> at(graph_.slots + 1);
        for (auto& layer : at) layer.resize(graph_.choices + 1);
        trail_.push_back(first_);
        at[graph_.begin][std::min(graph_.begin_choice, graph_.choices)].push_back(first_);
        for (std::size_t i = graph_.begin; i < graph_.slots; ++i) {
            expand(i, at);
            at[i].clear();
        }
        std::vector<StateLabel> finished;
        for (const auto& labels : at[graph_.slots]) finished.insert(finished.end(), labels.begin(), labels.end());
        std::ranges::sort(finished, std::ranges::greater(), &StateLabel::utility);
        if (!finished.empty()) {
            dropped_bound_ = std::max(dropped_bound_, finished.front().utility);
            const auto choices = choices_until(finished.front(), trail_, graph_);
            bound_is_flown_ = end_percent(question_.coarse, choices, question_.start) >=
                              question_.reserve_soc_percent - question_.coarse.error_percent;
        }
        constexpr std::size_t max_tried = 500;
        if (finished.size() > max_tried) finished.resize(max_tried);
        for (const auto& label : finished) try_schedule(label, best);
        return std::max(best.utility, dropped_bound_) + lost_;
    }

    /// Whether what has most utility lands, as far as the quick dynamics can tell: those limit the bound, and not the
    /// room.
    bool bound_is_flown() const { return bound_is_flown_; }

  private:
    using Layer = std::vector<std::vector<StateLabel>>;

    void try_schedule(const StateLabel& label, FoundSchedule& best) const {
        if (label.utility <= best.utility) return;
        FoundSchedule found{choices_until(label, trail_, graph_), 0.0, -infinite};
        for (std::size_t i = 0; i < found.choices.size(); ++i) {
            found.utility += question_.choices.utility_per_s[found.choices[i]] * question_.choices.slots[i].duration_s;
        }
        if (found.utility <= best.utility) return;
        found.end_percent = end_percent(question_.exact, found.choices, question_.start);
        if (found.end_percent >= question_.reserve_soc_percent) best = std::move(found);
    }

    bool is_wanted(double bound) {
        if (bound > enough_utility_) return true;
        dropped_bound_ = std::max(dropped_bound_, bound);
        return false;
    }

    void expand(std::size_t i, std::vector<Layer>& at) {
        std::vector<StateLabel> free;
        for (const auto& labels : at[i]) free.insert(free.end(), labels.begin(), labels.end());
        merge(i, free);
        leave_trail(free, trail_);
        for (std::size_t r = 0; r < graph_.runs[i].size(); ++r) {
            const auto& run = graph_.runs[i][r];
            carry(i, free, run, value_.runs[i][r], at[run.to][run.choice]);
        }
        for (std::size_t r = 0; r < graph_.one_more[i].size(); ++r) {
            const auto& run = graph_.one_more[i][r];
            auto& own = at[i][run.choice];
            merge(i, own);
            leave_trail(own, trail_);
            carry(i, own, run, value_.one_more[i][r], at[run.to][run.choice]);
        }
    }

    /// Appends what a run makes of the labels.
    void carry(std::size_t i, const std::vector<StateLabel>& labels, const ChoiceRun& run, const RunTransition& reach,
               std::vector<StateLabel>& to) {
        for (const auto& label : labels) {
            StateLabel next = label;
            next.choice = run.choice;
            next.to = run.to;
            next.utility += run.sum.utility;
            // What is known of the run beforehand saves most integrations.
            const auto end = apply_transition(value_, i, reach, label.charge);
            if (!is_wanted(next.utility + utility_to_go(value_, run.to, run.choice, end))) continue;
            const auto after = advance_run(question_.coarse, i, run.to, run.choice, next.state);
            if (!after) continue;
            next.state = *after;
            set_bound(value_, next);
            if (is_wanted(next.bound)) to.push_back(next);
        }
    }

    /// Of as many equal ranges of charge as half of the labels that there is room for, the most promising come before
    /// all others: so many. The labels are in the order of their charge.
    std::size_t raise_best_of_each_charge(std::vector<StateLabel>& labels) const {
        const auto half_of_room = limits_.max_labels / 2;
        const auto ranges = static_cast<double>(half_of_room);
        const double max_percent = labels.front().adjusted_percent;
        const double all_percent = std::max(1e-9, max_percent - labels.back().adjusted_percent);
        const auto range_of = [&](const StateLabel& label) {
            return std::min(ranges - 1.0, std::floor((max_percent - label.adjusted_percent) / all_percent * ranges));
        };
        std::size_t raised = 0;
        for (auto first = labels.begin(); first != labels.end(); ++raised) {
            const auto last = std::find_if(first, labels.end(),
                                           [&](const auto& label) { return range_of(label) != range_of(*first); });
            std::ranges::max_element(first, last, {}, &StateLabel::bound)->priority = infinite;
            first = last;
        }
        return raised;
    }

    void drop_least_promising(std::vector<StateLabel>& labels, std::size_t kept) {
        if (labels.size() <= kept) return;
        const auto last = labels.begin() + static_cast<std::ptrdiff_t>(kept);
        std::ranges::nth_element(labels, last, std::ranges::greater(), &StateLabel::priority);
        for (auto label = last; label != labels.end(); ++label) dropped_bound_ = std::max(dropped_bound_, label->bound);
        labels.erase(last, labels.end());
    }

    double promise_of(std::size_t i, const StateLabel& label) const {
        if (limits_.caution == nullptr) return label.bound;
        return label.utility + utility_to_go(*limits_.caution, i, label.state.soc_percent);
    }

    void merge(std::size_t i, std::vector<StateLabel>& labels) {
        constexpr double times_more = 1.5;
        std::ranges::sort(labels, [](const StateLabel& a, const StateLabel& b) {
            if (a.adjusted_percent != b.adjusted_percent) return a.adjusted_percent > b.adjusted_percent;
            if (a.utility != b.utility) return a.utility > b.utility;
            return a.state.soc_percent < b.state.soc_percent;
        });
        const MergeWeights weights{value_.rc_low[i], value_.rc_high[i], value_.rc_joined[i], utility_per_percent_,
                                   as_good_};
        auto kept = merge_labels(labels, weights, tolerance_);
        for (auto& label : kept) label.priority = promise_of(i, label);
        if (kept.size() > limits_.max_labels && limits_.crowd != LabelPruning::join) {
            const bool by_charge = limits_.crowd == LabelPruning::drop_by_charge;
            const auto half = limits_.max_labels / 2;
            drop_least_promising(
                kept, by_charge ? raise_best_of_each_charge(kept) + limits_.max_labels - half : limits_.max_labels);
        }
        while (kept.size() > limits_.max_labels) kept = merge_labels(labels, weights, tolerance_ *= times_more);
        labels = std::move(kept);
        for (auto& label : labels) set_bound(value_, label);
    }

    const ScheduleProblem& question_;
    const KnapsackGraph& graph_;
    const UtilityBound& value_;
    const StateLabel& first_;
    Limits limits_;
    double lost_ = 0.0;
    double as_good_ = 0.0;
    double tolerance_ = 0.0;
    double utility_per_percent_ = 0.0;
    double enough_utility_ = 0.0;
    double dropped_bound_ = -infinite;
    bool bound_is_flown_ = false;
    std::vector<RunStep> trail_;
};

/// The choices as a graph in which the least cost is the least energy demand.
KnapsackGraph graph_of(const ScheduleProblem& question) {
    auto choices = question.choices;
    for (std::size_t i = 0; i < choices.slots.size(); ++i) {
        auto& slot = choices.slots[i];
        slot.cost.clear();
        for (const double compute_w : question.exact.compute_w)
            slot.cost.push_back(question.exact.slots[i].mechanical_energy_j + compute_w * slot.duration_s);
    }
    return make_knapsack_graph(choices);
}

/// The schedule of least energy demand, and where it ends.
FoundSchedule least_schedule(const ScheduleProblem& question, const KnapsackGraph& graph) {
    const auto path = best_path(graph, cost_to_go(graph, 0.0, 1.0), 0.0, 1.0);
    return {path.choices, path.sum.utility, end_percent(question.exact, path.choices, question.start)};
}

/// As much of the effort as time and memory allow for many slots, choices or long runs.
SearchLimits affordable(SearchLimits effort, const KnapsackGraph& graph) {
    constexpr std::size_t max_slots_followed = 2000000;  // for the bound
    constexpr std::size_t max_labels_made = 6000000;
    constexpr std::size_t min_labels = 50;
    constexpr std::size_t min_cells = 8;
    std::size_t work = 1;
    for (const auto* each : {&graph.runs, &graph.one_more})
        for (std::size_t i = 0; i < graph.slots; ++i)
            for (const auto& run : (*each)[i]) work += run.to - i;
    effort.value_cells = std::min(effort.value_cells, std::max(min_cells, max_slots_followed / work));
    effort.max_labels = std::min(effort.max_labels, std::max(min_labels, max_labels_made / work));
    return effort;
}

constexpr std::size_t beam_labels = 100;
constexpr std::size_t times_beam = 5;
constexpr std::size_t few_slots = 20;

/// What a search has come to.
struct SearchState {
    FoundSchedule best;
    double bound = infinite;
    bool bound_is_flown = false;  ///< as StatePass has it, of the last one

    bool is_within(double relative_gap) const {
        return bound - best.utility <= relative_gap * std::max(std::abs(bound), 1e-9);
    }
};

/// Passes with ever more labels: the first drop what is less promising, to have a good schedule soon, the others prove.
void improve(const ScheduleProblem& question, const KnapsackGraph& graph, const SearchLimits& effort,
             SearchState& search) {
    const auto value = make_schedule_value(question, graph, effort.value_cells);
    // Behind the slots that are committed already.
    StateLabel first{{0, graph.begin_choice, 0}, question.start, graph.before_begin.utility};
    first.to = graph.begin;
    const auto begun = advance_run(question.coarse, 0, graph.begin, graph.begin_choice, question.start);
    if (!value.possible || !begun) {
        search.bound = search.best.utility;
        return;
    }
    first.state = *begun;
    set_bound(value, first);
    search.bound = std::min(search.bound, first.bound);
    const auto pass = [&](std::size_t labels, LabelPruning crowd, const HeuristicValue* caution = nullptr) {
        if (search.is_within(effort.relative_gap) || !std::isfinite(search.bound)) return;
        const double gap = effort.relative_gap * std::max(std::abs(search.bound), 1e-9);
        StatePass labelled(question, graph, value, first, {std::min(labels, effort.max_labels), gap, crowd, caution});
        search.bound = std::min(search.bound, labelled.run(search.best));
        search.bound_is_flown = labelled.bound_is_flown();
    };
    std::size_t labels = beam_labels;
    if (search.bound_is_flown) {
        labels *= times_beam;  // of a search before: a good schedule is known
    } else {
        pass(labels, LabelPruning::drop_by_bound);
        if (question.coarse.cutoff_voltage_v > 0.0 && !search.is_within(effort.relative_gap)) {
            pass(labels, LabelPruning::drop_by_charge);
            const auto caution = make_cautious_value(question, graph, value, effort.value_cells);
            pass(labels, LabelPruning::drop_by_caution, &caution);
        }
        if (effort.max_labels <= beam_labels) return;
    }
    do {
        labels *= times_beam;
        pass(labels, LabelPruning::join);
    } while (labels < effort.max_labels && !search.bound_is_flown);
}

/// Looks for a first schedule among those whose choices stay for a few slots: these are far fewer, and where a cut-off
/// comes late a search among all of them seldom meets one that lands with much.
void begin_with_long_runs(const ScheduleProblem& question, SearchState& search) {
    constexpr double slots_a_run = 3.0;
    constexpr SearchLimits quick_effort{1e-3, beam_labels, 32};
    auto choices = question.choices;
    const double mission_s = std::accumulate(choices.slots.begin(), choices.slots.end(), 0.0,
                                             [](double sum_s, const auto& slot) { return sum_s + slot.duration_s; });
    choices.dwell_s = std::max(choices.dwell_s, slots_a_run * mission_s / static_cast<double>(choices.slots.size()));
    const ScheduleProblem coarse{question.exact, question.coarse, question.medium,
                                 choices,        question.start,  question.reserve_soc_percent};
    const auto graph = graph_of(coarse);
    if (!graph.possible) return;
    SearchState found{search.best};
    improve(coarse, graph, affordable(quick_effort, graph), found);
    search.best = std::move(found.best);
}

}  // namespace

KnapsackSolution search_schedule(const ScheduleProblem& question, const SearchLimits& wanted_effort) {
    const auto graph = graph_of(question);
    const auto effort = affordable(wanted_effort, graph);
    const auto least = least_schedule(question, graph);
    SearchState search;
    if (least.end_percent >= question.reserve_soc_percent) search.best = least;
    const bool may_take_time = effort.max_labels > times_beam * beam_labels;  // and is none of a flight's many plans
    if (question.coarse.cutoff_voltage_v > 0.0 && graph.slots > few_slots && may_take_time)
        begin_with_long_runs(question, search);
    improve(question, graph, effort, search);
    if (!search.is_within(effort.relative_gap) && search.bound_is_flown) {
        // What keeps the bound up lands in the quick dynamics, but not in the exact ones.
        const ScheduleProblem closer{question.exact,   question.medium, question.medium,
                                     question.choices, question.start,  question.reserve_soc_percent};
        improve(closer, graph, effort, search);
    }
    KnapsackSolution result;
    result.possible = true;
    result.feasible = std::isfinite(search.best.utility);
    const auto& found = result.feasible ? search.best : least;
    result.choices = found.choices;
    result.utility = found.utility;
    result.cost = question.start.soc_percent - found.end_percent;
    result.bound = result.feasible ? std::max(search.bound, found.utility) : 0.0;
    return result;
}

}  // namespace flightwatt::mission
