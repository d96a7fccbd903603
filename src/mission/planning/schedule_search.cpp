#include "mission/planning/schedule_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace flightwatt::mission {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A part of a schedule that ends with a run; `before` is where the run before stands in the trail.
struct RunStep {
    std::size_t before = 0;
    std::size_t choice = 0;
    std::size_t to = 0;
};

/// A schedule of the first slots, by its last run, what it leaves of the battery, and its utility.
struct StateLabel : RunStep {
    battery::BatteryState state;
    double utility = 0.0;
    EffectiveCharge charge = {};
    double weighed_percent = 0.0;  ///< the charge less what its RC voltage costs at least
    double bound = 0.0;            ///< nothing that begins so has more utility
};

struct FoundSchedule {
    std::vector<std::size_t> choices;
    double utility = -infinite;
    double end_percent = -infinite;
};

/// Carries the label's battery through the slots of its last run, from `from` on; false if it does not last.
bool follow(const SlotDynamics& dynamics, std::size_t from, StateLabel& label) {
    for (std::size_t i = from; i < label.to; ++i) {
        const auto after = after_slot(dynamics, i, label.choice, label.state);
        if (!after) return false;
        label.state = *after;
    }
    return true;
}

void set_bound(const ScheduleValue& value, StateLabel& label) {
    label.charge = effective_charge(value, label.to, label.state);
    label.weighed_percent = label.state.soc_percent - value.rc_low[label.to] * label.state.rc_voltage_v;
    label.bound = label.utility + utility_to_go(value, label.to, label.choice, label.charge);
}

/// Utilities by keys, of which none is less than another one's with both less key and less utility.
class UtilityFront {
  public:
    /// Whether something with as much key has as much utility, or nearly.
    bool dominates(double key, double utility, double as_good) const {
        const auto found = utility_by_key_.lower_bound(key);
        return found != utility_by_key_.end() && found->second + as_good >= utility;
    }

    void add(double key, double utility) {
        auto at = utility_by_key_.insert_or_assign(key, utility).first;
        while (at != utility_by_key_.begin() && std::prev(at)->second <= utility) utility_by_key_.erase(std::prev(at));
    }

  private:
    std::map<double, double> utility_by_key_;
};

/// One pass from the first slot to the last with at most so many labels at a time.
class StatePass {
  public:
    struct Limits {
        std::size_t most_labels = 0;
        double utility_gap = 0.0;
        bool is_proof = true;  ///< false: labels are compared as if nothing was cut off, to find a good schedule soon
    };

    StatePass(const ScheduleQuestion& question, const KnapsackGraph& graph, const ScheduleValue& value,
              const StateLabel& first, const Limits& limits)
        : question_(question), graph_(graph), value_(value), first_(first), limits_(limits) {
        // Half of the gap for what is dropped as good as dominated, in two prunings a slot; half for bounds.
        as_good_ = limits.utility_gap / 2.0 / static_cast<double>(2 * graph.slots + 2);
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
        const auto finished = merged(graph_.slots, at[graph_.slots]);
        const auto most = std::ranges::max_element(finished, {}, &StateLabel::utility);
        if (most != finished.end() && most->utility > best.utility)
            best = {choices_of(*most), most->utility, most->state.soc_percent};
        const double lost = as_good_ * static_cast<double>(2 * graph_.slots + 2);
        return std::max(best.utility, dropped_bound_) + lost;
    }

  private:
    using Layer = std::vector<std::vector<StateLabel>>;

    bool is_wanted(double bound) {
        if (bound > enough_utility_) return true;
        dropped_bound_ = std::max(dropped_bound_, bound);
        return false;
    }

    void expand(std::size_t i, std::vector<Layer>& at) {
        auto free = merged(i, at[i]);
        leave_trail(free);
        for (std::size_t r = 0; r < graph_.runs[i].size(); ++r) {
            const auto& run = graph_.runs[i][r];
            carry(i, free, run, value_.runs[i][r], at[run.to][run.choice]);
        }
        for (std::size_t r = 0; r < graph_.one_more[i].size(); ++r) {
            const auto& run = graph_.one_more[i][r];
            auto& own = at[i][run.choice];
            prune(i, own);
            leave_trail(own);
            carry(i, own, run, value_.one_more[i][r], at[run.to][run.choice]);
        }
    }

    std::vector<StateLabel> merged(std::size_t i, const Layer& layer) {
        std::vector<StateLabel> all;
        for (const auto& labels : layer) all.insert(all.end(), labels.begin(), labels.end());
        prune(i, all);
        return all;
    }

    /// Puts the labels' last runs into the trail: only those that survived, for it grows with every slot.
    void leave_trail(std::vector<StateLabel>& labels) {
        for (auto& label : labels) {
            trail_.push_back(label);
            label.before = trail_.size() - 1;
        }
    }

    /// Appends what a run makes of the labels.
    void carry(std::size_t i, const std::vector<StateLabel>& labels, const ChoiceRun& run, const RunReach& reach,
               std::vector<StateLabel>& to) {
        for (const auto& label : labels) {
            const double utility = label.utility + run.sum.utility;
            // What is known of the run beforehand saves most integrations.
            const auto end = reached(value_, i, reach, label.charge);
            if (!is_wanted(utility + utility_to_go(value_, run.to, run.choice, end))) continue;
            StateLabel next{{label.before, run.choice, run.to}, label.state, utility};
            if (!follow(question_.dynamics, i, next)) continue;
            set_bound(value_, next);
            if (is_wanted(next.bound)) to.push_back(next);
        }
    }

    /// Leaves labels that no other one at the same slot dominates, or nearly, and of those the most promising.
    /// A label is as good as another one in any case if it has as much charge and, with RC voltage weighed by
    /// what it may cost at most, as much again; or no more RC voltage, where that may end a flight.
    void prune(std::size_t i, std::vector<StateLabel>& labels) {
        std::ranges::sort(labels, [](const StateLabel& a, const StateLabel& b) {
            if (a.weighed_percent != b.weighed_percent) return a.weighed_percent > b.weighed_percent;
            return a.utility != b.utility ? a.utility > b.utility : a.state.soc_percent < b.state.soc_percent;
        });
        const double high = (limits_.is_proof ? value_.rc_high : value_.rc_usual)[i];
        UtilityFront front;
        std::erase_if(labels, [&](const StateLabel& label) {
            const double key = std::isfinite(high) ? label.state.soc_percent - high * label.state.rc_voltage_v
                                                   : -label.state.rc_voltage_v;
            if (front.dominates(key, label.utility, as_good_)) return true;
            front.add(key, label.utility);
            return false;
        });
        if (labels.size() <= limits_.most_labels) return;
        const auto last = labels.begin() + static_cast<std::ptrdiff_t>(limits_.most_labels);
        std::ranges::nth_element(labels, last, std::ranges::greater(), &StateLabel::bound);
        dropped_bound_ = std::max(dropped_bound_, last->bound);
        labels.erase(last, labels.end());
    }

    std::vector<std::size_t> choices_of(const StateLabel& label) const {
        std::vector<std::size_t> choices(graph_.slots, graph_.begin_choice);
        for (RunStep step = label; step.to > graph_.begin;) {
            const auto& before = trail_[step.before];
            std::fill(choices.begin() + static_cast<std::ptrdiff_t>(before.to),
                      choices.begin() + static_cast<std::ptrdiff_t>(step.to), step.choice);
            step = before;
        }
        return choices;
    }

    const ScheduleQuestion& question_;
    const KnapsackGraph& graph_;
    const ScheduleValue& value_;
    const StateLabel& first_;
    Limits limits_;
    double as_good_ = 0.0;
    double enough_utility_ = 0.0;
    double dropped_bound_ = -infinite;
    std::vector<RunStep> trail_;
};

/// The choices as a graph in which the least cost is the least energy demand.
KnapsackGraph graph_of(const ScheduleQuestion& question) {
    auto choices = question.choices;
    for (std::size_t i = 0; i < choices.slots.size(); ++i) {
        auto& slot = choices.slots[i];
        slot.cost.clear();
        for (const double compute_w : question.dynamics.compute_w)
            slot.cost.push_back(question.dynamics.slots[i].mechanical_energy_j + compute_w * slot.duration_s);
    }
    return make_knapsack_graph(choices);
}

/// The schedule of least energy demand, and where it ends.
FoundSchedule least_schedule(const ScheduleQuestion& question, const KnapsackGraph& graph) {
    const auto path = best_path(graph, cost_to_go(graph, 0.0, 1.0), 0.0, 1.0);
    FoundSchedule least{path.choices, path.sum.utility, -infinite};
    auto state = question.start;
    for (std::size_t i = 0; i < path.choices.size(); ++i) {
        const auto after = after_slot(question.dynamics, i, path.choices[i], state);
        if (!after || after->soc_percent < 0.0) return least;
        state = *after;
    }
    least.end_percent = state.soc_percent;
    return least;
}

/// As much of the effort as time and memory allow for many slots, choices or long runs.
KnapsackEffort affordable(KnapsackEffort effort, const KnapsackGraph& graph) {
    constexpr std::size_t most_slots_followed = 2000000;  // for the bound
    constexpr std::size_t most_labels_made = 6000000;
    constexpr std::size_t fewest_labels = 50;
    constexpr std::size_t fewest_cells = 8;
    std::size_t work = 1;
    for (const auto* each : {&graph.runs, &graph.one_more})
        for (std::size_t i = 0; i < graph.slots; ++i)
            for (const auto& run : (*each)[i]) work += run.to - i;
    effort.value_cells = std::min(effort.value_cells, std::max(fewest_cells, most_slots_followed / work));
    effort.most_labels = std::min(effort.most_labels, std::max(fewest_labels, most_labels_made / work));
    return effort;
}

}  // namespace

KnapsackSolution search_schedule(const ScheduleQuestion& question, const KnapsackEffort& wanted_effort) {
    constexpr std::size_t labels_at_first = 50;
    constexpr std::size_t times_more = 10;
    const auto graph = graph_of(question);
    const auto effort = affordable(wanted_effort, graph);
    KnapsackSolution result;
    result.possible = true;
    const auto finish = [&](const FoundSchedule& found, bool feasible, double bound) {
        result.feasible = feasible;
        result.choices = found.choices;
        result.utility = found.utility;
        result.cost = question.start.soc_percent - found.end_percent;
        result.bound = bound;
        return result;
    };
    const auto least = least_schedule(question, graph);
    const auto value = make_schedule_value(question, graph, effort.value_cells);
    // Behind the slots that are committed already.
    StateLabel first{{0, graph.begin_choice, graph.begin}, question.start, graph.before_begin.utility};
    if (!value.possible || !follow(question.dynamics, 0, first)) return finish(least, false, 0.0);
    FoundSchedule best;
    if (least.end_percent >= question.reserve_soc_percent) best = least;
    set_bound(value, first);
    double bound = first.bound;
    // Where a cut-off may end flights, few labels dominate others: what is best but for that comes first.
    bool is_proof = value.rc_high == value.rc_usual;
    for (std::size_t labels = labels_at_first; std::isfinite(bound);) {
        const double gap = effort.relative_gap * std::max(std::abs(bound), 1e-9);
        if (bound - best.utility <= gap) break;
        const auto most = std::min(labels, effort.most_labels);
        const double found = StatePass(question, graph, value, first, {most, gap, is_proof}).run(best);
        if (is_proof) bound = std::min(bound, found);
        const bool is_last = labels >= effort.most_labels;
        if (is_proof && is_last) break;
        if (!is_proof && (is_last || found - best.utility <= gap)) {
            is_proof = true;
            labels = effort.most_labels;
        } else {
            labels *= times_more;
        }
    }
    if (!std::isfinite(best.utility)) return finish(least, false, 0.0);
    return finish(best, true, std::max(bound, best.utility));
}

}  // namespace flightwatt::mission
