#include "mission/planning/utility_bound.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace flightwatt::mission {
namespace {

constexpr double cannot_land = -std::numeric_limits<double>::infinity();

/// Returns whether b is on or below the line from a to c.
bool is_under(const CurvePoint& a, const CurvePoint& b, const CurvePoint& c) {
    return (b.y - a.y) * (c.x - a.x) <= (c.y - a.y) * (b.x - a.x);
}

auto first_beyond(const ConcaveCurve& curve, double x) {
    return std::ranges::upper_bound(curve, x, {}, &CurvePoint::x);
}

/// Adds points of `gain` plus `curve` after a run, from charges within one cell. The run leads from the upper end of
/// the cell to `end_maps_to`; from lower charges it draws no less, as two charges never approach each other.
void add_run_points(const ConcaveCurve& curve, double cell_start, double cell_end, double end_maps_to, double gain,
                    std::vector<CurvePoint>& points) {
    if (curve.empty() || !(end_maps_to >= curve.front().x)) return;
    const double drawn = cell_end - end_maps_to;
    const double start_maps_to = cell_start - drawn;
    points.push_back({cell_end, gain + value_at(curve, end_maps_to)});
    for (auto point = first_beyond(curve, start_maps_to); point != curve.end() && point->x < end_maps_to; ++point)
        points.push_back({point->x + drawn, gain + point->y});
    if (start_maps_to >= curve.front().x) points.push_back({cell_start, gain + value_at(curve, start_maps_to)});
}

/// The choices of least and greatest power that a slot may run.
struct ChoiceRange {
    std::size_t least = 0;
    std::size_t greatest = 0;
};

ChoiceRange range_of(const ScheduleProblem& problem, std::size_t slot) {
    if (const auto fixed = problem.choices.slots[slot].fixed) return {*fixed, *fixed};
    const auto& compute_w = problem.dynamics.compute_w;
    ChoiceRange range;
    for (std::size_t c = 0; c < compute_w.size(); ++c) {
        const bool continues = problem.choices.running && problem.choices.running->choice == c;
        if (c >= problem.choices.free_choices && !continues) continue;
        if (compute_w[c] < compute_w[range.least]) range.least = c;
        if (compute_w[c] > compute_w[range.greatest]) range.greatest = c;
    }
    return range;
}

/// Sets the states of the schedule of least power.
void fly_least_power(const ScheduleProblem& problem, UtilityBound& bound) {
    bound.best_state = {problem.start};
    for (std::size_t i = 0; i < problem.dynamics.slots.size(); ++i) {
        const auto after = advance_slot(problem.dynamics, i, range_of(problem, i).least, bound.best_state.back());
        if (!after) return;
        bound.best_state.push_back(*after);
    }
    bound.lands = bound.best_state.back().soc_percent >= problem.reserve_soc_percent;
}

/// Sets by bisection the charge from which the schedule of least power lands with the least RC voltage.
void set_lowest_charge(const ScheduleProblem& problem, UtilityBound& bound) {
    constexpr int halvings = 20;
    const double spare_percent = bound.best_state.back().soc_percent - problem.reserve_soc_percent;
    bound.lowest_percent.assign(bound.best_state.size(), problem.reserve_soc_percent);
    for (std::size_t i = problem.dynamics.slots.size(); i-- > 0;) {
        const auto& best = bound.best_state[i];
        const double too_low = best.soc_percent - spare_percent;  // two charges never approach each other
        bound.lowest_percent[i] = last_true(too_low, best.soc_percent, halvings, [&](double percent) {
            const battery::BatteryState tried{percent, best.rc_voltage_v};
            const auto after = advance_slot(problem.dynamics, i, range_of(problem, i).least, tried);
            return !after || after->soc_percent < bound.lowest_percent[i + 1];
        });
    }
}

/// Returns the greatest slope [V/point] of the open-circuit voltage.
double max_slope(const SlotDynamics& dynamics) {
    const auto& [knots, volts] = dynamics.open_circuit;
    double slope = 0.0;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
        slope = std::max(slope, (volts[k + 1] - volts[k]) / (knots[k + 1] - knots[k]));
    return slope;
}

/// Returns the charge [points] that a volt of RC voltage costs from a slot's start on, if it costs `later` after the
/// slot; infinite where it ends the flight. The open-circuit voltage is constant.
double rc_cost(const SlotDynamics& flat, std::size_t slot, std::size_t choice, double rc_v, double step_v,
               double later) {
    constexpr double any_percent = 50.0;
    const auto usual = advance_slot(flat, slot, choice, {any_percent, rc_v});
    const auto other = advance_slot(flat, slot, choice, {any_percent, rc_v + step_v});
    if (!usual || !other || !std::isfinite(later)) return -cannot_land;
    return (usual->soc_percent - other->soc_percent + later * (other->rc_voltage_v - usual->rc_voltage_v)) / step_v;
}

/// Sets the least and greatest cost of RC voltage, from the mission's end back. A volt costs current for as long as it
/// lasts: the least with the least power at the highest open-circuit voltage, the most with the greatest power at the
/// lowest voltages of all schedules that land. That the open-circuit voltage then falls less lowers the cost, by no
/// more than a part of slope times cost (Eq. 30).
void set_rc_costs(const ScheduleProblem& problem, UtilityBound& bound) {
    constexpr double step_v = 1e-3;
    const std::size_t slots = problem.dynamics.slots.size();
    bound.rc_min_cost.assign(slots + 1, 0.0);
    bound.rc_max_cost.assign(slots + 1, 0.0);
    if (problem.dynamics.circuit.rc_resistance_ohm == 0.0) return;
    auto flat = problem.dynamics;
    const auto set_charge = [&](double soc_percent) {
        const double volts = battery::VoltageLine(problem.dynamics.open_circuit, soc_percent)(soc_percent);
        flat.open_circuit = {{0.0, 100.0}, {volts, volts}};
    };
    std::vector<double> greatest_rc_v{problem.start.rc_voltage_v};
    flat.cutoff_voltage_v = 0.0;
    for (std::size_t i = 0; i < slots; ++i) {
        set_charge(bound.lowest_percent[i + 1]);
        const auto after = advance_slot(flat, i, range_of(problem, i).greatest, {100.0, greatest_rc_v[i]});
        greatest_rc_v.push_back(after ? after->rc_voltage_v : -cannot_land);
    }
    flat.cutoff_voltage_v = problem.dynamics.cutoff_voltage_v;
    for (std::size_t i = slots; i-- > 0;) {
        const auto [least, greatest] = range_of(problem, i);
        set_charge(bound.lowest_percent[i + 1]);
        bound.rc_max_cost[i] = rc_cost(flat, i, greatest, greatest_rc_v[i], step_v, bound.rc_max_cost[i + 1]);
        set_charge(bound.best_state[i].soc_percent);
        bound.rc_min_cost[i] =
            rc_cost(flat, i, least, bound.best_state[i].rc_voltage_v, -step_v, bound.rc_min_cost[i + 1]);
    }
    const double part = max_slope(problem.dynamics) * *std::ranges::max_element(bound.rc_min_cost);
    for (auto& cost : bound.rc_min_cost) cost *= std::max(0.0, 1.0 - part);
}

/// Sets the RC voltages of a schedule as reference, where they are not the least and may not end the flight.
void set_reference(const ScheduleProblem& problem, const std::vector<std::size_t>& choices, UtilityBound& bound) {
    for (const auto& state : bound.best_state) bound.reference_rc_v.push_back(state.rc_voltage_v);
    std::optional<battery::BatteryState> state = problem.start;
    for (std::size_t i = 0; i < choices.size() && state; ++i) {
        constexpr double full_percent = 100.0;
        const auto& [best_percent, least_rc_v] = bound.best_state[i];
        const double above_v = std::max(0.0, state->rc_voltage_v - least_rc_v);
        if (best_percent + bound.rc_max_cost[i] * above_v <= full_percent) bound.reference_rc_v[i] += above_v;
        state = advance_slot(problem.dynamics, i, choices[i], *state);
    }
}

/// Returns the charge that is no worse than a state, with the reference RC voltage.
double effective_percent(const UtilityBound& bound, std::size_t slot, const battery::BatteryState& state) {
    const double above_v = state.rc_voltage_v - bound.reference_rc_v[slot];
    const bool is_above = above_v >= 0.0 || !std::isfinite(bound.rc_max_cost[slot]);  // or differs by rounding
    return state.soc_percent - above_v * (is_above ? bound.rc_min_cost[slot] : bound.rc_max_cost[slot]);
}

/// Returns the upper end [%] of a cell, from 1 on; of 0 the least effective charge.
double cell_end(const UtilityBound& bound, std::size_t slot, std::size_t cell) {
    const double part = static_cast<double>(cell) / static_cast<double>(bound.cells);
    return std::lerp(bound.lowest_percent[slot], effective_percent(bound, slot, bound.best_state[slot]), part);
}

const ConcaveCurve& curve_with(const UtilityBound& bound, std::size_t slot, std::size_t choice) {
    const auto& running = bound.running[slot];
    return choice < running.size() && !running[choice].empty() ? running[choice] : bound.free[slot];
}

/// Adds a run to the points of its slot's curve.
void add_run(const ScheduleProblem& problem, std::size_t slot, const ChoiceRun& run, UtilityBound& bound,
             std::vector<CurvePoint>& points) {
    const double rc_v = bound.reference_rc_v[slot];
    for (std::size_t cell = 1; cell <= bound.cells; ++cell) {
        const double start_percent = cell_end(bound, slot, cell);
        const auto end = advance_run(problem.dynamics, slot, run.to, run.choice, {start_percent, rc_v});
        if (!end) continue;
        add_run_points(curve_with(bound, run.to, run.choice), cell_end(bound, slot, cell - 1), start_percent,
                       effective_percent(bound, run.to, *end), run.utility, points);
    }
}

/// Sets the curves of one slot by those of the slots after it.
void set_curves(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t slot, UtilityBound& bound) {
    std::vector<CurvePoint> begun;
    std::vector<std::vector<CurvePoint>> continued(graph.choices);
    for (const auto& run : graph.runs[slot])
        add_run(problem, slot, run, bound, run.continues ? continued[run.choice] : begun);
    bound.free[slot] = concave_hull(std::move(begun));
    bound.running[slot].resize(graph.choices);
    for (std::size_t choice = 0; choice < graph.choices; ++choice) {
        auto& points = continued[choice];
        if (points.empty()) continue;
        points.insert(points.end(), bound.free[slot].begin(), bound.free[slot].end());
        bound.running[slot][choice] = concave_hull(std::move(points));
    }
}

}  // namespace

ConcaveCurve concave_hull(std::vector<CurvePoint> points) {
    std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y > b.y; });
    ConcaveCurve hull;
    for (const auto& point : points) {
        if (!hull.empty() && point.y <= hull.back().y) continue;  // below where the curve is level
        while (hull.size() >= 2 && is_under(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
        hull.push_back(point);
    }
    return hull;
}

double value_at(const ConcaveCurve& curve, double x) {
    if (curve.empty() || x < curve.front().x) return cannot_land;
    if (x >= curve.back().x) return curve.back().y;
    const auto b = first_beyond(curve, x);
    const auto a = b - 1;
    return a->y + (b->y - a->y) * ((x - a->x) / (b->x - a->x));
}

UtilityBound make_utility_bound(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t cells,
                                const std::vector<std::size_t>& reference) {
    UtilityBound bound;
    const auto& [percent, volts] = problem.dynamics.open_circuit;
    bound.cells = volts.front() == volts.back() ? 1 : cells;  // a constant source: depletion is the same at any charge
    fly_least_power(problem, bound);
    if (!bound.lands) return bound;
    set_lowest_charge(problem, bound);
    set_rc_costs(problem, bound);
    set_reference(problem, reference, bound);
    bound.free.resize(graph.slots + 1);
    bound.running.resize(graph.slots + 1);
    bound.free.back() = {{problem.reserve_soc_percent, 0.0}};
    for (std::size_t i = graph.slots; i-- > graph.begin;) set_curves(problem, graph, i, bound);
    return bound;
}

double utility_to_go(const UtilityBound& bound, std::size_t slot, std::size_t choice,
                     const battery::BatteryState& state) {
    return value_at(curve_with(bound, slot, choice), effective_percent(bound, slot, state));
}

}  // namespace flightwatt::mission
