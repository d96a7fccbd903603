#include "mission/planning/schedule_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

namespace flightwatt::mission {
namespace {

constexpr std::size_t max_compared = 32;  // labels before one in the order of charge, to become one with

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

double joining_costs(const StateLabel& into, const StateLabel& label, const MergeWeights& weights) {
    return weights.utility_per_percent * weights.rc_joined *
           std::abs(into.state.rc_voltage_v - label.state.rc_voltage_v);
}

/// The state of `into` becomes one that is no worse than either.
void join(const StateLabel& label, const MergeWeights& weights, StateLabel& into) {
    auto& state = into.state;
    const auto& other = label.state;
    const double rc_v = std::min(state.rc_voltage_v, other.rc_voltage_v);
    state.soc_percent = std::max(state.soc_percent - weights.rc_low * (state.rc_voltage_v - rc_v),
                                 other.soc_percent - weights.rc_low * (other.rc_voltage_v - rc_v));
    state.rc_voltage_v = rc_v;
    into.utility = std::max(into.utility, label.utility);
}

constexpr double unreachable = -std::numeric_limits<double>::infinity();

/// RC voltage after a choice has run for long.
double steady_rc_v(const SlotDynamics& dynamics, std::size_t slot, double compute_w, double soc_percent) {
    const double power_w = dynamics.slots[slot].mechanical_energy_j / dynamics.slots[slot].duration_s + compute_w;
    const double source_v = open_circuit_voltage_v(dynamics, soc_percent);
    const double both_ohm = dynamics.circuit.resistance_ohm + dynamics.circuit.rc_resistance_ohm;
    const double discriminant = source_v * source_v - 4.0 * both_ohm * power_w;
    return dynamics.circuit.rc_resistance_ohm * 2.0 * power_w / (source_v + std::sqrt(std::max(0.0, discriminant)));
}

double after_run(const ScheduleProblem& problem, const UtilityBound& bounds, const HeuristicValue& value,
                 std::size_t from, const ChoiceRun& run, double soc_percent) {
    const auto& dynamics = problem.coarse;
    const double min_w = *std::ranges::min_element(dynamics.compute_w);
    const double more_v = steady_rc_v(dynamics, from, dynamics.compute_w[run.choice], soc_percent) -
                          steady_rc_v(dynamics, from, min_w, soc_percent);
    const auto after = advance_run(dynamics, from, run.to, run.choice,
                                   {soc_percent, bounds.min_power_trajectory[from].rc_voltage_v + more_v});
    return after ? run.utility + utility_to_go(value, run.to, after->soc_percent) : unreachable;
}

}  // namespace

std::vector<StateLabel> merge_labels(const std::vector<StateLabel>& labels, const MergeWeights& weights,
                                     double tolerance) {
    std::vector<StateLabel> kept;
    std::vector<double> utility_as_kept;
    UtilityFront front;
    for (const auto& label : labels) {
        const double key = std::isfinite(weights.rc_high)
                               ? label.state.soc_percent - weights.rc_high * label.state.rc_voltage_v
                               : -label.state.rc_voltage_v;
        if (front.dominates(key, label.utility, weights.utility_tolerance)) continue;
        const std::size_t first = kept.size() > max_compared ? kept.size() - max_compared : 0;
        std::size_t at = kept.size();
        while (at > first && (label.utility > utility_as_kept[at - 1] + tolerance ||
                              joining_costs(kept[at - 1], label, weights) > tolerance))
            --at;
        if (at > first) {
            join(label, weights, kept[at - 1]);
            continue;
        }
        front.add(key, label.utility);
        kept.push_back(label);
        utility_as_kept.push_back(label.utility);
    }
    return kept;
}

HeuristicValue make_cautious_value(const ScheduleProblem& problem, const ScheduleGraph& graph,
                                   const UtilityBound& bounds, std::size_t cells) {
    HeuristicValue value;
    value.at.resize(graph.slots + 1);
    for (std::size_t i = graph.slots + 1; i-- > graph.begin;) {
        auto& at = value.at[i];
        const double max_percent = bounds.min_power_trajectory[i].soc_percent;
        at.min_percent =
            bounds.min_charge_percent.empty() ? problem.reserve_soc_percent : bounds.min_charge_percent[i].front();
        at.step_percent = std::max(1e-9, max_percent - at.min_percent) / static_cast<double>(cells);
        at.utility.assign(cells + 1, i == graph.slots ? 0.0 : unreachable);
        if (i == graph.slots) continue;
        for (std::size_t k = 0; k <= cells; ++k) {
            const double soc_percent = at.min_percent + at.step_percent * static_cast<double>(k);
            for (const auto& run : graph.runs[i])
                at.utility[k] = std::max(at.utility[k], after_run(problem, bounds, value, i, run, soc_percent));
        }
    }
    return value;
}

double utility_to_go(const HeuristicValue& value, std::size_t slot, double soc_percent) {
    const auto& [min_percent, step_percent, utility] = value.at[slot];
    const double place = (soc_percent - min_percent) / step_percent;
    if (!(place >= 0.0)) return unreachable;
    const auto lower = std::min(static_cast<std::size_t>(place), utility.size() - 2);
    if (utility[lower] == unreachable) return unreachable;
    return std::lerp(utility[lower], utility[lower + 1], std::min(1.0, place - static_cast<double>(lower)));
}

}  // namespace flightwatt::mission
