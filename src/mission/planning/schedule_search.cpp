#include "mission/planning/schedule_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flightwatt::mission {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

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
    label.effective_percent = effective_percent(value, label.to, label.state);
    label.adjusted_percent = label.state.soc_percent - value.rc_low[label.to] * label.state.rc_voltage_v;
    label.bound = may_land(value, label.to, label.state)
                      ? label.utility + utility_to_go(value, label.to, label.choice, label.effective_percent)
                      : -infinite;
}

/// Puts the labels' last runs into the trail: only those that survived, for it grows with every slot.
void leave_trail(std::vector<StateLabel>& labels, std::vector<RunStep>& trail) {
    for (auto& label : labels) {
        trail.push_back(label);
        label.before = trail.size() - 1;
    }
}

/// One pass from the first slot to the last with a limited number of labels.
class StatePass {
  public:
    struct Limits {
        std::size_t max_labels = 0;
        double utility_gap = 0.0;
        bool merges = false;                      ///< merges similar labels to limit their number, else drops some
        const HeuristicValue* ranking = nullptr;  ///< of dropped labels; none: by their bound
    };

    StatePass(const ScheduleProblem& problem, const ScheduleGraph& graph, const UtilityBound& value,
              const StateLabel& first, const Limits& limits)
        : problem_(problem), graph_(graph), value_(value), first_(first), limits_(limits) {
        constexpr double part_for_rounding = 1e-3;
        lost_ = part_for_rounding * limits.utility_gap;
        as_good_ = lost_ / static_cast<double>(2 * graph.slots + 2);  // of two merges a slot
        tolerance_ = limits.utility_gap / static_cast<double>(2 * graph.slots + 2);
        utility_per_percent_ = first.bound / std::max(1e-9, value.spare_percent);
    }

    /// Replaces `best` by a better schedule, if one is found. Returns an upper bound of the utility.
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
            bound_lands_ = end_percent(problem_.coarse, choices, problem_.start) >=
                           problem_.reserve_soc_percent - problem_.coarse.error_percent;
        }
        constexpr std::size_t max_tried = 500;
        if (finished.size() > max_tried) finished.resize(max_tried);
        for (const auto& label : finished) try_schedule(label, best);
        return std::max(best.utility, dropped_bound_) + lost_;
    }

    /// Whether the label of greatest utility lands in the coarse dynamics: these then limit the bound, not the number
    /// of labels.
    bool bound_lands() const { return bound_lands_; }

  private:
    using Layer = std::vector<std::vector<StateLabel>>;

    void try_schedule(const StateLabel& label, FoundSchedule& best) const {
        if (label.utility <= best.utility) return;
        FoundSchedule found{choices_until(label, trail_, graph_), 0.0, -infinite};
        found.utility = utility_of(problem_.choices, found.choices);
        if (found.utility <= best.utility) return;
        found.end_percent = end_percent(problem_.exact, found.choices, problem_.start);
        if (found.end_percent >= problem_.reserve_soc_percent) best = std::move(found);
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

    /// Appends the labels after a run.
    void carry(std::size_t i, const std::vector<StateLabel>& labels, const ChoiceRun& run, const RunTransition& reach,
               std::vector<StateLabel>& to) {
        for (const auto& label : labels) {
            StateLabel next = label;
            next.choice = run.choice;
            next.to = run.to;
            next.utility += run.utility;
            // The tabulated transition saves most integrations.
            const auto end = apply_transition(value_, i, reach, label.effective_percent);
            if (!is_wanted(next.utility + utility_to_go(value_, run.to, run.choice, end))) continue;
            const auto after = advance_run(problem_.coarse, i, run.to, run.choice, next.state);
            if (!after) continue;
            next.state = *after;
            set_bound(value_, next);
            if (is_wanted(next.bound)) to.push_back(next);
        }
    }

    void drop_lowest_priority(std::vector<StateLabel>& labels) {
        if (labels.size() <= limits_.max_labels) return;
        const auto last = labels.begin() + static_cast<std::ptrdiff_t>(limits_.max_labels);
        std::ranges::nth_element(labels, last, std::ranges::greater(), &StateLabel::priority);
        for (auto label = last; label != labels.end(); ++label) dropped_bound_ = std::max(dropped_bound_, label->bound);
        labels.erase(last, labels.end());
    }

    double priority_of(std::size_t i, const StateLabel& label) const {
        if (limits_.ranking == nullptr) return label.bound;
        return label.utility + utility_to_go(*limits_.ranking, i, label.state.soc_percent);
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
        for (auto& label : kept) label.priority = priority_of(i, label);
        if (!limits_.merges) drop_lowest_priority(kept);
        while (kept.size() > limits_.max_labels) kept = merge_labels(labels, weights, tolerance_ *= times_more);
        labels = std::move(kept);
        for (auto& label : labels) set_bound(value_, label);
    }

    const ScheduleProblem& problem_;
    const ScheduleGraph& graph_;
    const UtilityBound& value_;
    const StateLabel& first_;
    Limits limits_;
    double lost_ = 0.0;
    double as_good_ = 0.0;
    double tolerance_ = 0.0;
    double utility_per_percent_ = 0.0;
    double enough_utility_ = 0.0;
    double dropped_bound_ = -infinite;
    bool bound_lands_ = false;
    std::vector<RunStep> trail_;
};

/// The schedule of least energy demand, and where it ends.
FoundSchedule least_schedule(const ScheduleProblem& problem, const ScheduleGraph& graph) {
    auto choices = least_choices(problem.choices, graph, problem.exact.compute_w);
    const double utility = utility_of(problem.choices, choices);
    const double end = end_percent(problem.exact, choices, problem.start);
    return {std::move(choices), utility, end};
}

/// As much of the effort as time and memory allow for many slots, choices or long runs.
SearchLimits affordable(SearchLimits effort, const SlotDynamics& dynamics, const ScheduleGraph& graph) {
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
    if (!dynamics.depletion_percent.empty()) effort.value_cells = 1;  // a choice takes the same at any charge
    return effort;
}

constexpr std::size_t beam_labels = 100;
constexpr std::size_t times_beam = 5;
constexpr std::size_t few_slots = 20;

/// Result of a search so far.
struct SearchState {
    FoundSchedule best;
    double bound = infinite;
    bool bound_lands = false;  ///< as StatePass has it, of the last one

    bool is_within(double relative_gap) const {
        return bound - best.utility <= relative_gap * std::max(std::abs(bound), 1e-9);
    }
};

/// Passes with increasing numbers of labels: the first ones find a good schedule, the others prove.
void improve(const ScheduleProblem& problem, const ScheduleGraph& graph, const SearchLimits& effort,
             SearchState& search) {
    const auto value = make_schedule_value(problem, graph, effort.value_cells);
    // Behind the slots that are committed already.
    StateLabel first{{0, graph.begin_choice, 0}, problem.start, graph.utility_before_begin};
    first.to = graph.begin;
    const auto begun = advance_run(problem.coarse, 0, graph.begin, graph.begin_choice, problem.start);
    if (!value.possible || !begun) {
        search.bound = search.best.utility;
        return;
    }
    first.state = *begun;
    set_bound(value, first);
    search.bound = std::min(search.bound, first.bound);
    const auto pass = [&](std::size_t labels, bool merges, const HeuristicValue* ranking = nullptr) {
        if (search.is_within(effort.relative_gap) || !std::isfinite(search.bound)) return;
        const double gap = effort.relative_gap * std::max(std::abs(search.bound), 1e-9);
        StatePass labelled(problem, graph, value, first, {std::min(labels, effort.max_labels), gap, merges, ranking});
        search.bound = std::min(search.bound, labelled.run(search.best));
        search.bound_lands = labelled.bound_lands();
    };
    std::size_t labels = beam_labels;
    if (search.bound_lands) {
        labels *= times_beam;  // of a search before: a good schedule is known
    } else {
        pass(labels, false);
        if (problem.coarse.cutoff_voltage_v > 0.0 && !search.is_within(effort.relative_gap)) {
            const auto ranking = make_cautious_value(problem, graph, value, effort.value_cells);
            pass(labels, false, &ranking);
        }
        if (effort.max_labels <= beam_labels) return;
    }
    do {
        labels *= times_beam;
        pass(labels, true);
    } while (labels < effort.max_labels && !search.bound_lands);
}

/// Searches first among the fewer schedules whose choices stay for several slots: before a late cut-off, a search over
/// all schedules rarely finds a good one.
void begin_with_long_runs(const ScheduleProblem& problem, SearchState& search) {
    constexpr double slots_a_run = 3.0;
    constexpr SearchLimits quick_effort{1e-3, beam_labels, 32};
    auto choices = problem.choices;
    const double mission_s = std::accumulate(choices.slots.begin(), choices.slots.end(), 0.0,
                                             [](double sum_s, const auto& slot) { return sum_s + slot.duration_s; });
    choices.dwell_s = std::max(choices.dwell_s, slots_a_run * mission_s / static_cast<double>(choices.slots.size()));
    const ScheduleProblem coarse{problem.exact, problem.coarse, problem.medium,
                                 choices,       problem.start,  problem.reserve_soc_percent};
    const auto graph = make_schedule_graph(choices);
    SearchState found{search.best};
    improve(coarse, graph, affordable(quick_effort, problem.coarse, graph), found);
    search.best = std::move(found.best);
}

}  // namespace

SearchResult search_schedule(const ScheduleProblem& problem, const SearchLimits& wanted_effort) {
    const auto graph = make_schedule_graph(problem.choices);
    const auto effort = affordable(wanted_effort, problem.coarse, graph);
    const auto least = least_schedule(problem, graph);
    SearchState search;
    if (least.end_percent >= problem.reserve_soc_percent) search.best = least;
    const bool may_take_time = effort.max_labels > times_beam * beam_labels;  // not in flight
    if (problem.coarse.cutoff_voltage_v > 0.0 && graph.slots > few_slots && may_take_time)
        begin_with_long_runs(problem, search);
    improve(problem, graph, effort, search);
    if (!search.is_within(effort.relative_gap) && search.bound_lands) {
        // The label that limits the bound lands in the coarse dynamics, but not in the exact ones.
        const ScheduleProblem closer{problem.exact,   problem.medium, problem.medium,
                                     problem.choices, problem.start,  problem.reserve_soc_percent};
        improve(closer, graph, effort, search);
    }
    SearchResult result;
    result.feasible = std::isfinite(search.best.utility);
    result.best = result.feasible ? search.best : least;
    if (result.feasible) result.bound = std::max(search.bound, result.best.utility);
    return result;
}

}  // namespace flightwatt::mission
