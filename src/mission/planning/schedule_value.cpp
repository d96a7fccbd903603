#include "mission/planning/schedule_value.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace flightwatt::mission {
namespace {

constexpr double never = -std::numeric_limits<double>::infinity();
constexpr double between_samples = 0.01;  // of a power: what it may be beyond its samples

/// Compute power that a slot runs at least and at most.
struct ComputeRange {
    double min_w = 0.0;
    double max_w = 0.0;
    std::size_t min_choice = 0;
};

ComputeRange range_of(const ScheduleProblem& problem, std::size_t slot) {
    const auto& compute_w = problem.coarse.compute_w;
    if (const auto fixed = problem.choices.slots[slot].fixed) return {compute_w[*fixed], compute_w[*fixed], *fixed};
    ComputeRange range{compute_w[0], compute_w[0], 0};
    for (std::size_t c = 0; c < compute_w.size(); ++c) {
        const bool is_free = c < problem.choices.free_choices;
        const bool continues = problem.choices.running && problem.choices.running->choice == c;
        if (!is_free && !continues) continue;
        if (compute_w[c] < range.min_w) {
            range.min_w = compute_w[c];
            range.min_choice = c;
        }
        range.max_w = std::max(range.max_w, compute_w[c]);
    }
    return range;
}

/// The lines of the open-circuit voltage that a range of charge touches.
struct SlopeRange {
    double least = 0.0;
    double greatest = 0.0;
};

SlopeRange slopes_in(const SlotDynamics& dynamics, double from_percent, double to_percent) {
    const auto& [knots, volts] = dynamics.open_circuit;
    SlopeRange slopes{std::numeric_limits<double>::infinity(), 0.0};
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        if (knots[k] > to_percent || knots[k + 1] < from_percent) continue;
        const double slope_v_per_percent = (volts[k + 1] - volts[k]) / (knots[k + 1] - knots[k]);
        slopes.least = std::min(slopes.least, slope_v_per_percent);
        slopes.greatest = std::max(slopes.greatest, slope_v_per_percent);
    }
    if (!(from_percent >= knots.front()) || !std::isfinite(slopes.least)) slopes.least = 0.0;
    return slopes;
}

/// No schedule that lands has less in the quick dynamics.
double quick_reserve_percent(const ScheduleProblem& problem) {
    return problem.reserve_soc_percent - problem.coarse.error_percent;
}

bool fly_least(const ScheduleProblem& problem, UtilityBound& value) {
    value.min_power_trajectory = {problem.start};
    for (std::size_t i = 0; i < problem.coarse.slots.size(); ++i) {
        const auto after =
            advance_slot(problem.coarse, i, range_of(problem, i).min_choice, value.min_power_trajectory.back());
        if (!after) return false;
        value.min_power_trajectory.push_back(*after);
    }
    value.spare_percent = value.min_power_trajectory.back().soc_percent - quick_reserve_percent(problem);
    return value.spare_percent >= 0.0;
}

double min_percent(const UtilityBound& value, std::size_t slot) {
    return value.min_power_trajectory[slot].soc_percent - value.spare_percent;
}

/// After a time in which da/dt = rate - decay a.
double relaxed(double a, double rate, double decay_per_s, double time_s) {
    const double kept = std::exp(-decay_per_s * time_s);
    return a * kept + (decay_per_s > 0.0 ? rate / decay_per_s * (1.0 - kept) : rate * time_s);
}

/// The current at a voltage before the resistor, and how it rises as that falls; none beyond the limit. Both grow with
/// the power and fall with the voltage.
struct CurrentBound {
    double current_a = 0.0;
    double current_a_per_v = 0.0;
};

std::optional<CurrentBound> current_bound(double power_w, double source_v, double resistance_ohm) {
    const double discriminant = source_v * source_v - 4.0 * resistance_ohm * power_w;
    if (!(source_v > 0.0) || !(discriminant > 0.0)) return std::nullopt;
    const double root = std::sqrt(discriminant);
    const double current_a = 2.0 * power_w / (source_v + root);
    return CurrentBound{current_a, current_a / root};
}

/// A volt of RC voltage costs current, the least at the least power, for as long as it lasts; with it goes a part of
/// the charge, whose slope makes up for some of it.
void set_rc_low(const ScheduleProblem& problem, UtilityBound& value) {
    const auto& dynamics = problem.coarse;
    value.rc_low.assign(dynamics.slots.size() + 1, 0.0);
    if (dynamics.circuit.rc_resistance_ohm == 0.0) return;
    const double steepest =
        slopes_in(dynamics, min_percent(value, dynamics.slots.size()), value.min_power_trajectory.front().soc_percent)
            .greatest;
    for (std::size_t i = dynamics.slots.size(); i-- > 0;) {
        const auto& slot = dynamics.slots[i];
        const double power_w = slot.min_mechanical_w + range_of(problem, i).min_w;
        const double source_v = open_circuit_voltage_v(dynamics, value.min_power_trajectory[i].soc_percent);
        const auto bound = current_bound(std::max(0.0, power_w), source_v, dynamics.circuit.resistance_ohm);
        const double percent_per_vs =
            bound ? (1.0 - between_samples) * bound->current_a_per_v * dynamics.circuit.percent_per_as : 0.0;
        const double decay_per_s = 1.0 / dynamics.circuit.rc_time_constant_s + steepest * percent_per_vs;
        value.rc_low[i] = relaxed(value.rc_low[i + 1], percent_per_vs, decay_per_s, slot.duration_s);
    }
}

double max_w(const ScheduleProblem& problem, std::size_t slot) {
    return (1.0 + between_samples) *
           std::max(0.0, problem.coarse.slots[slot].max_mechanical_w + range_of(problem, slot).max_w);
}

/// The greatest RC voltage of what lands; none if the power limit is near.
std::optional<double> max_rc_v(const ScheduleProblem& problem, const UtilityBound& value) {
    const auto& dynamics = problem.coarse;
    double power_w = 0.0;
    for (std::size_t i = 0; i < dynamics.slots.size(); ++i) power_w = std::max(power_w, max_w(problem, i));
    const double rest_v = open_circuit_voltage_v(dynamics, min_percent(value, dynamics.slots.size()));
    double rc_v = problem.start.rc_voltage_v;
    constexpr int rounds = 50;  // to where the current's own voltage holds it
    for (int round = 0; round < rounds; ++round) {
        const auto bound = current_bound(power_w, rest_v - rc_v, dynamics.circuit.resistance_ohm);
        if (!bound) return std::nullopt;
        const double next_v =
            std::max(problem.start.rc_voltage_v, dynamics.circuit.rc_resistance_ohm * bound->current_a);
        if (next_v <= rc_v * (1.0 + 1e-9)) return next_v * (1.0 + 1e-6);
        rc_v = next_v;
    }
    return std::nullopt;
}

/// Charge that outweighs a volt of RC voltage at once: it keeps the voltage before the resistor higher, and with that
/// the current lower, for ever.
double outweighing_percent_per_v(const SlotDynamics& dynamics, double from_percent, double to_percent) {
    const double least = slopes_in(dynamics, from_percent, to_percent).least;
    return least > 0.0 ? 1.0 / least : std::numeric_limits<double>::infinity();
}

/// Upper counterpart of set_rc_low: the greatest cost of a volt, unless a cut-off or the power limit could end a flight
/// that lands otherwise; then the charge that outweighs it.
void set_rc_high(const ScheduleProblem& problem, UtilityBound& value) {
    const auto& dynamics = problem.coarse;
    value.rc_usual.assign(dynamics.slots.size() + 1, 0.0);
    value.rc_high.assign(dynamics.slots.size() + 1, 0.0);
    value.rc_joined = value.rc_high;
    if (dynamics.circuit.rc_resistance_ohm == 0.0) return;
    const auto rc_v = max_rc_v(problem, value);
    const double end_percent = min_percent(value, dynamics.slots.size());
    bool may_end = false;
    double of_limit = 0.0;  // gain by a volt in a slot whose power the voltage limits
    for (std::size_t i = dynamics.slots.size(); i-- > 0;) {
        const double source_v = open_circuit_voltage_v(dynamics, min_percent(value, i + 1)) - rc_v.value_or(0.0);
        const auto bound = current_bound(max_w(problem, i), source_v, dynamics.circuit.resistance_ohm);
        const double outweighs =
            outweighing_percent_per_v(dynamics, end_percent, value.min_power_trajectory[i].soc_percent);
        double usual = outweighs;
        if (bound && dynamics.circuit.rc_resistance_ohm * bound->current_a_per_v < 1.0) {
            const double decay_per_s = (1.0 - dynamics.circuit.rc_resistance_ohm * bound->current_a_per_v) /
                                       dynamics.circuit.rc_time_constant_s;
            usual = std::min(outweighs,
                             relaxed(value.rc_usual[i + 1], bound->current_a_per_v * dynamics.circuit.percent_per_as,
                                     decay_per_s, dynamics.slots[i].duration_s));
        }
        const bool may_end_here =
            !rc_v || !bound ||
            source_v - dynamics.circuit.resistance_ohm * bound->current_a < dynamics.cutoff_voltage_v;
        may_end = may_end || may_end_here;
        const double duration_s = dynamics.slots[i].duration_s;
        of_limit *= std::exp(-duration_s / dynamics.circuit.rc_time_constant_s);
        if (may_end_here) {
            const double percent_per_v =
                dynamics.circuit.percent_per_as * duration_s / std::max(1e-3, dynamics.circuit.resistance_ohm);
            of_limit = std::max(of_limit, percent_per_v);
        }
        value.rc_joined[i] = of_limit + (std::isfinite(usual) ? (usual - value.rc_low[i]) / 2.0 : value.rc_low[i]);
        value.rc_usual[i] = usual;
        value.rc_high[i] = may_end ? outweighs : usual;
    }
}

double cell_percent(const UtilityBound& value) {
    return std::max(value.spare_percent, 1e-9) / static_cast<double>(value.cells);
}

double energy_j(const SlotDynamics& dynamics, std::size_t from, const ChoiceRun& run) {
    double sum_j = 0.0;
    for (std::size_t i = from; i < run.to; ++i)
        sum_j += dynamics.slots[i].mechanical_energy_j + dynamics.compute_w[run.choice] * dynamics.slots[i].duration_s;
    return sum_j;
}

void set_max_above(const ScheduleProblem& problem, UtilityBound& value) {
    const auto& dynamics = problem.coarse;
    value.max_above_v.assign(dynamics.slots.size() + 1, 0.0);
    if (dynamics.circuit.rc_resistance_ohm == 0.0) return;
    for (std::size_t i = 0; i < dynamics.slots.size(); ++i) {
        const auto range = range_of(problem, i);
        const double source_v = open_circuit_voltage_v(dynamics, value.min_power_trajectory[i].soc_percent);
        const double steady_v = dynamics.circuit.rc_resistance_ohm * (range.max_w - range.min_w) / source_v;
        value.max_above_v[i + 1] = relaxed(value.max_above_v[i], steady_v / dynamics.circuit.rc_time_constant_s,
                                           1.0 / dynamics.circuit.rc_time_constant_s, dynamics.slots[i].duration_s);
    }
}

/// From the mission's end back, by bisection.
void set_enough(const ScheduleProblem& problem, UtilityBound& value) {
    constexpr std::size_t steps = 40;
    constexpr int halvings = 20;
    const auto& dynamics = problem.coarse;
    if (dynamics.cutoff_voltage_v == 0.0) return;
    const std::size_t slots = dynamics.slots.size();
    for (std::size_t i = 0; i <= slots; ++i)
        value.enough_step_v.push_back(value.max_above_v[i] / static_cast<double>(steps));
    value.min_charge_percent.assign(slots + 1, std::vector<double>(steps + 1, quick_reserve_percent(problem)));
    for (std::size_t i = slots; i-- > 0;) {
        for (std::size_t k = 0; k <= steps; ++k) {
            const double rc_v =
                value.min_power_trajectory[i].rc_voltage_v + value.enough_step_v[i] * static_cast<double>(k);
            double too_low = min_percent(value, i);
            double high = value.min_power_trajectory[i].soc_percent;
            for (int halving = 0; halving < halvings; ++halving) {
                const double middle = std::midpoint(too_low, high);
                const auto after = advance_slot(dynamics, i, range_of(problem, i).min_choice, {middle, rc_v});
                (after && may_land(value, i + 1, *after) ? high : too_low) = middle;
            }
            value.min_charge_percent[i][k] = too_low;
        }
    }
}

const ConcaveCurve& curve_with(const UtilityBound& value, std::size_t slot, std::size_t choice) {
    const auto& with = value.with[slot];
    return choice < with.size() && !with[choice].points.empty() ? with[choice] : value.any[slot];
}

/// Two charges diverge as the higher one's voltage saves current: of a slope m by m P / U^2 points a second or more.
RunTransition reach_of(const SlotDynamics& dynamics, const UtilityBound& value, std::size_t from,
                       const ChoiceRun& run) {
    RunTransition reach{std::vector<double>(value.cells + 1, never), std::vector<double>(value.cells + 1, 1.0)};
    const double run_j = energy_j(dynamics, from, run);
    std::optional<double> lower_end;
    for (std::size_t j = 0; j <= value.cells; ++j) {
        const double start_percent = min_percent(value, from) + cell_percent(value) * static_cast<double>(j);
        const auto end = advance_run(dynamics, from, run.to, run.choice,
                                     {start_percent, value.min_power_trajectory[from].rc_voltage_v});
        if (!end || !may_land(value, run.to, *end)) continue;
        reach.end_percent[j] = effective_percent(value, run.to, *end);
        if (lower_end) {
            const double source_v = open_circuit_voltage_v(dynamics, start_percent);
            reach.growth[j] += slopes_in(dynamics, *lower_end, start_percent).least * dynamics.circuit.percent_per_as *
                               std::max(0.0, run_j) / (source_v * source_v);
        }
        lower_end = end->soc_percent;
    }
    return reach;
}

void add_run_points(const UtilityBound& value, std::size_t from, const ChoiceRun& run, const RunTransition& reach,
                    std::vector<CurvePoint>& points) {
    const auto& next = curve_with(value, run.to, run.choice);
    const double step = cell_percent(value);
    for (std::size_t j = 1; j <= value.cells; ++j) {
        const double end_percent = min_percent(value, from) + step * static_cast<double>(j);
        add_mapped(next, {end_percent - step, end_percent, reach.end_percent[j], reach.growth[j]}, run.utility, points);
    }
}

/// The curves of one slot, of those behind it.
void set_curves(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t i, UtilityBound& value) {
    std::vector<CurvePoint> points;
    for (const auto& run : graph.runs[i]) {
        value.runs[i].push_back(reach_of(problem.coarse, value, i, run));
        add_run_points(value, i, run, value.runs[i].back(), points);
    }
    value.any[i] = concave_hull(std::move(points));
    if (!graph.one_more[i].empty()) value.with[i].resize(graph.choices);
    for (const auto& run : graph.one_more[i]) {
        value.one_more[i].push_back(reach_of(problem.coarse, value, i, run));
        auto own = value.any[i].points;
        add_run_points(value, i, run, value.one_more[i].back(), own);
        value.with[i][run.choice] = concave_hull(std::move(own));
    }
}

}  // namespace

UtilityBound make_schedule_value(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t cells) {
    UtilityBound value;
    value.cells = cells;
    value.possible = fly_least(problem, value);
    if (!value.possible) return value;
    set_rc_low(problem, value);
    set_rc_high(problem, value);
    set_max_above(problem, value);
    set_enough(problem, value);
    value.any.resize(graph.slots + 1);
    value.with.resize(graph.slots + 1);
    value.runs.resize(graph.slots);
    value.one_more.resize(graph.slots);
    value.any.back() = {{{quick_reserve_percent(problem), 0.0}}};
    for (std::size_t i = graph.slots; i-- > graph.begin;) set_curves(problem, graph, i, value);
    return value;
}

bool may_land(const UtilityBound& value, std::size_t slot, const battery::BatteryState& state) {
    if (value.min_charge_percent.empty()) return true;
    const auto& enough = value.min_charge_percent[slot];
    const double step_v = value.enough_step_v[slot];
    const double above_v = state.rc_voltage_v - value.min_power_trajectory[slot].rc_voltage_v;
    const double most = static_cast<double>(enough.size() - 1);
    const double steps = step_v > 0.0 ? std::clamp(std::floor(above_v / step_v), 0.0, most) : 0.0;
    return state.soc_percent >= enough[static_cast<std::size_t>(steps)];
}

double effective_percent(const UtilityBound& value, std::size_t slot, const battery::BatteryState& state) {
    const double above_v = state.rc_voltage_v - value.min_power_trajectory[slot].rc_voltage_v;
    return state.soc_percent - value.rc_low[slot] * above_v;
}

double utility_to_go(const UtilityBound& value, std::size_t slot, std::size_t choice, double percent) {
    return value_at(curve_with(value, slot, choice), percent);
}

double apply_transition(const UtilityBound& value, std::size_t slot, const RunTransition& reach, double percent) {
    const double step = cell_percent(value);
    const double lowest = min_percent(value, slot);
    const double position = std::ceil((percent - lowest) / step);
    const auto j = static_cast<std::size_t>(std::clamp(position, 1.0, static_cast<double>(value.cells)));
    return reach.end_percent[j] - reach.growth[j] * (lowest + step * static_cast<double>(j) - percent);
}

}  // namespace flightwatt::mission
