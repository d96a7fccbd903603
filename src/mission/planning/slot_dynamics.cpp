#include "mission/planning/slot_dynamics.h"

#include "base/units.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::mission {
namespace {

constexpr double max_step_s = 4.0;
constexpr double shortest_step_s = 0.05;
constexpr double wanted_agreement_percent = 1e-7;
constexpr double longest_quick_step_s = 20.0;
constexpr double quick_agreement_percent = coarse_error_percent / 10.0;

using Moment = battery::CircuitMoment;
using SlotRun = battery::CircuitRun;

bool is_deliverable(const SlotDynamics& dynamics, const Moment& moment) {
    return moment.spare_v2 >= -2.0 * dynamics.error_v * moment.source_v;
}

/// The knot of the open-circuit voltage between two charges, if there is one.
std::optional<double> knot_between(const SlotDynamics& dynamics, double from_percent, double to_percent) {
    const auto& knots = dynamics.open_circuit.soc_percent;
    const auto [low, high] = std::minmax(from_percent, to_percent);
    const auto above = std::ranges::upper_bound(knots, low);
    return above != knots.end() && *above < high ? std::optional(*above) : std::nullopt;
}

SlotDynamics::Part dynamics_part_of(const SlotDynamics& dynamics, const LoadSegment& segment, double longest_step_s,
                                    double mechanical_factor) {
    const double duration_s = segment.duration_s();
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / longest_step_s * (1.0 - 1e-12))));
    const double step_s = duration_s / static_cast<double>(steps);
    SlotDynamics::Part part{step_s, {dynamics.circuit, step_s}, {}};
    part.mechanical_w.resize(2 * steps + 1);
    for (std::size_t k = 0; k < part.mechanical_w.size(); ++k) {
        const double time_s = segment.start_s + part.step_s / 2.0 * static_cast<double>(k);
        part.mechanical_w[k] = mechanical_factor * mechanical_w(segment, time_s);
    }
    return part;
}

SlotDynamics::Slot slot_of(const SlotDynamics& dynamics, const std::vector<LoadSegment>& segments, double step_s,
                           double mechanical_factor) {
    SlotDynamics::Slot slot;
    slot.min_mechanical_w = std::numeric_limits<double>::infinity();
    slot.max_mechanical_w = -slot.min_mechanical_w;
    for (const auto& segment : segments) {
        slot.duration_s += segment.duration_s();
        slot.mechanical_energy_j += mechanical_factor * mechanical_energy_j(segment, segment.end_s);
        slot.parts.push_back(dynamics_part_of(dynamics, segment, step_s, mechanical_factor));
        const auto [least, greatest] = std::ranges::minmax_element(slot.parts.back().mechanical_w);
        slot.min_mechanical_w = std::min(slot.min_mechanical_w, *least);
        slot.max_mechanical_w = std::max(slot.max_mechanical_w, *greatest);
    }
    return slot;
}

/// A step over which power is a parabola.
struct SlotStep {
    battery::Parabola power_w;
    double length_s;
    const battery::StepLength& length;
};

/// Result of a step.
struct StepEnd {
    Moment end;
    double middle_percent = 0.0;
    double min_v = 0.0;
};

StepEnd after_step(SlotRun& run, const SlotStep& step, const Moment& start) {
    StepEnd after{start};
    auto middle = start;
    middle.power_w = step.power_w.middle;
    after.end.power_w = step.power_w.end;
    run.step(step.length, start, middle, after.end);
    after.middle_percent = middle.soc_percent;
    after.min_v = battery::Parabola{start.terminal_v, middle.terminal_v, after.end.terminal_v}.minimum();
    return after;
}

/// The same in two steps that meet where the charge passes the knot, as the voltage is no parabola beyond it.
StepEnd after_knot(const SlotDynamics& dynamics, SlotRun& run, const SlotStep& step, const Moment& start,
                   const battery::Parabola& beyond_knot) {
    const auto part_of = [&](double from, double to, Moment at) {
        const auto& power_w = step.power_w;
        const double length_s = (to - from) * step.length_s;
        const battery::StepLength length(dynamics.circuit, length_s);
        return after_step(run, {{power_w.at(from), power_w.at((from + to) / 2.0), power_w.at(to)}, length_s, length},
                          at);
    };
    const double knot = std::clamp(beyond_knot.first_zero_crossing(), 0.0, 1.0);
    if (knot == 0.0 || knot == 1.0) return after_step(run, step, start);
    const auto before = part_of(0.0, knot, start);
    auto after = part_of(knot, 1.0, before.end);
    after.min_v = std::min(before.min_v, after.min_v);
    return after;
}

std::optional<battery::BatteryState> after_part(const SlotDynamics& dynamics, const SlotDynamics::Part& part,
                                                double compute_w, SlotRun& run, const battery::BatteryState& state) {
    constexpr double rounding_v = 1e-6;
    const double cutoff_v = dynamics.cutoff_voltage_v;
    const double min_v = cutoff_v > 0.0 ? cutoff_v - dynamics.error_v - rounding_v : -1.0;
    const auto power_w = [&](std::size_t k) { return part.mechanical_w[k] + compute_w; };
    Moment now{.soc_percent = state.soc_percent, .rc_voltage_v = state.rc_voltage_v, .power_w = power_w(0)};
    run.complete(now);
    if (!is_deliverable(dynamics, now) || now.terminal_v < min_v) return std::nullopt;
    for (std::size_t k = 0; k + 1 < part.mechanical_w.size(); k += 2) {
        const SlotStep step{{power_w(k), power_w(k + 1), power_w(k + 2)}, part.step_s, part.step};
        auto after = after_step(run, step, now);
        const double from_percent = now.soc_percent;
        const double to_percent = after.end.soc_percent;
        if (const auto knot = knot_between(dynamics, from_percent, to_percent)) {
            const double sign = from_percent > to_percent ? 1.0 : -1.0;
            after = after_knot(
                dynamics, run, step, now,
                {sign * (from_percent - *knot), sign * (after.middle_percent - *knot), sign * (to_percent - *knot)});
        }
        if (!is_deliverable(dynamics, after.end) || after.min_v < min_v) return std::nullopt;
        now = after.end;
    }
    return battery::BatteryState{now.soc_percent, now.rc_voltage_v};
}

/// Over longer steps the RC pair's transient is no parabola.
double max_transient_s(const battery::Battery& battery) {
    const bool has_pair = battery.thevenin && battery.thevenin->rc_resistance_ohm > 0.0;
    return has_pair ? battery.thevenin->rc_time_constant_s : std::numeric_limits<double>::infinity();
}

/// Whether missions that run one choice throughout end with the same charge, where both end.
bool agree(const SlotDynamics& a, const SlotDynamics& b, double soc_percent, double within_percent) {
    for (std::size_t choice = 0; choice < a.compute_w.size(); ++choice) {
        const auto end = advance_run(a, 0, a.slots.size(), choice, {soc_percent});
        const auto other = advance_run(b, 0, b.slots.size(), choice, {soc_percent});
        if (!end || !other || end->soc_percent < 0.0 || other->soc_percent < 0.0) continue;
        if (std::abs(end->soc_percent - other->soc_percent) > within_percent) return false;
    }
    return true;
}

/// Of the choices of least and most power, which nothing cuts off.
SlotDynamics extreme_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                              const std::vector<double>& compute_w, double step_s) {
    const auto [least, most] = std::ranges::minmax_element(compute_w);
    auto dynamics = make_slot_dynamics(mission, slots, {*least, *most}, step_s);
    dynamics.cutoff_voltage_v = 0.0;
    return dynamics;
}

std::vector<std::vector<double>> depletion_table(const SlotDynamics& dynamics) {
    std::vector<std::vector<double>> table(dynamics.slots.size());
    for (std::size_t slot = 0; slot < table.size(); ++slot) {
        for (std::size_t choice = 0; choice < dynamics.compute_w.size(); ++choice) {
            const auto end = advance_slot(dynamics, slot, choice, {0.0});
            table[slot].push_back(end ? -end->soc_percent : std::numeric_limits<double>::infinity());
        }
    }
    return table;
}

}  // namespace

SlotDynamics make_slot_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                                std::vector<double> compute_w, double step_s, double mechanical_factor) {
    SlotDynamics dynamics;
    dynamics.circuit = battery::circuit_of(mission.battery);
    dynamics.open_circuit = battery::open_circuit_of(mission.battery);
    dynamics.cutoff_voltage_v = mission.cutoff_voltage_v;
    dynamics.compute_w = std::move(compute_w);
    const auto load = make_mission_load(mission);
    dynamics.slots.reserve(slots.size());
    for (const auto& slot : slots)
        dynamics.slots.push_back(slot_of(dynamics, load_segments(load, {slot, {}}), step_s, mechanical_factor));
    if (!mission.battery.thevenin && mission.cutoff_voltage_v == 0.0)
        dynamics.depletion_percent = depletion_table(dynamics);
    return dynamics;
}

double choose_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                     const std::vector<double>& compute_w) {
    double step_s = std::min(max_step_s, max_transient_s(mission.battery) / 2.0);
    auto dynamics = extreme_dynamics(mission, slots, compute_w, step_s);
    while (step_s > shortest_step_s) {
        auto halved = extreme_dynamics(mission, slots, compute_w, step_s / 2.0);
        if (agree(dynamics, halved, mission.initial_soc_percent, wanted_agreement_percent)) break;
        step_s /= 2.0;
        dynamics = std::move(halved);
    }
    return step_s;
}

double choose_coarse_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                            const std::vector<double>& compute_w, double step_s) {
    const auto exact = extreme_dynamics(mission, slots, compute_w, step_s);
    double quick_s = step_s;
    const double max_s = std::min(longest_quick_step_s, max_transient_s(mission.battery));
    while (quick_s * 2.0 <= max_s && agree(exact, extreme_dynamics(mission, slots, compute_w, quick_s * 2.0),
                                           mission.initial_soc_percent, quick_agreement_percent))
        quick_s *= 2.0;
    return quick_s;
}

std::optional<battery::BatteryState> advance_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                  const battery::BatteryState& state) {
    if (!dynamics.depletion_percent.empty()) {
        const double after_percent = state.soc_percent - dynamics.depletion_percent[slot][choice];
        if (!std::isfinite(after_percent)) return std::nullopt;
        return battery::BatteryState{std::min(after_percent, 100.0), state.rc_voltage_v};
    }
    SlotRun run(dynamics.circuit, battery::VoltageLine(dynamics.open_circuit, state.soc_percent));
    std::optional<battery::BatteryState> after = state;
    for (const auto& part : dynamics.slots[slot].parts)
        if (after) after = after_part(dynamics, part, dynamics.compute_w[choice], run, *after);
    return after;
}

std::optional<battery::BatteryState> advance_run(const SlotDynamics& dynamics, std::size_t from, std::size_t to,
                                                 std::size_t choice, const battery::BatteryState& state) {
    std::optional<battery::BatteryState> after = state;
    for (std::size_t i = from; i < to && after; ++i) after = advance_slot(dynamics, i, choice, *after);
    return after;
}

double open_circuit_voltage_v(const SlotDynamics& dynamics, double soc_percent) {
    return battery::VoltageLine(dynamics.open_circuit, soc_percent)(soc_percent);
}

}  // namespace flightwatt::mission
