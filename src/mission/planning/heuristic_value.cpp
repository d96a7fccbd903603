#include "mission/planning/heuristic_value.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::mission {
namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

/// What a choice's current leaves across the RC pair when it has run for long.
double steady_rc_v(const SlotDynamics& dynamics, std::size_t slot, double compute_w, double soc_percent) {
    const double power_w = dynamics.slots[slot].mechanical_energy_j / dynamics.slots[slot].duration_s + compute_w;
    const double source_v = open_circuit_voltage_v(dynamics, soc_percent);
    const double both_ohm = dynamics.circuit.resistance_ohm + dynamics.circuit.rc_resistance_ohm;
    const double discriminant = source_v * source_v - 4.0 * both_ohm * power_w;
    return dynamics.circuit.rc_resistance_ohm * 2.0 * power_w / (source_v + std::sqrt(std::max(0.0, discriminant)));
}

double after_run(const ScheduleProblem& question, const UtilityBound& bounds, const HeuristicValue& value,
                 std::size_t from, const ChoiceRun& run, double soc_percent) {
    const auto& dynamics = question.coarse;
    const double min_w = *std::ranges::min_element(dynamics.compute_w);
    const double more_v = steady_rc_v(dynamics, from, dynamics.compute_w[run.choice], soc_percent) -
                          steady_rc_v(dynamics, from, min_w, soc_percent);
    battery::BatteryState state{soc_percent, bounds.min_power_trajectory[from].rc_voltage_v + more_v};
    for (std::size_t i = from; i < run.to; ++i) {
        const auto after = advance_slot(dynamics, i, run.choice, state);
        if (!after) return never;
        state = *after;
    }
    return run.sum.utility + utility_to_go(value, run.to, state.soc_percent);
}

}  // namespace

HeuristicValue make_cautious_value(const ScheduleProblem& question, const KnapsackGraph& graph,
                                   const UtilityBound& bounds, std::size_t cells) {
    HeuristicValue value;
    value.at.resize(graph.slots + 1);
    for (std::size_t i = graph.slots + 1; i-- > graph.begin;) {
        auto& at = value.at[i];
        const double max_percent = bounds.min_power_trajectory[i].soc_percent;
        at.min_percent =
            bounds.min_charge_percent.empty() ? question.reserve_soc_percent : bounds.min_charge_percent[i].front();
        at.step_percent = std::max(1e-9, max_percent - at.min_percent) / static_cast<double>(cells);
        at.utility.assign(cells + 1, i == graph.slots ? 0.0 : never);
        if (i == graph.slots) continue;
        for (std::size_t k = 0; k <= cells; ++k) {
            const double soc_percent = at.min_percent + at.step_percent * static_cast<double>(k);
            for (const auto& run : graph.runs[i])
                at.utility[k] = std::max(at.utility[k], after_run(question, bounds, value, i, run, soc_percent));
        }
    }
    return value;
}

double utility_to_go(const HeuristicValue& value, std::size_t slot, double soc_percent) {
    const auto& [min_percent, step_percent, utility] = value.at[slot];
    const double place = (soc_percent - min_percent) / step_percent;
    if (!(place >= 0.0)) return never;
    const auto lower = std::min(static_cast<std::size_t>(place), utility.size() - 2);
    if (utility[lower] == never) return never;
    return std::lerp(utility[lower], utility[lower + 1], std::min(1.0, place - static_cast<double>(lower)));
}

}  // namespace flightwatt::mission
