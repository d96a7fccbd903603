#include "mission/planning/slot_dynamics.h"

#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::mission {
namespace {

using Moment = battery::CircuitMoment;
using battery::CircuitRun;

/// The state of charge [%] in between two others at which the slope of the open-circuit voltage changes, if any.
std::optional<double> knot_between(const SlotDynamics& dynamics, double from_percent, double to_percent) {
    const auto& knots = dynamics.open_circuit.soc_percent;
    const auto [low, high] = std::minmax(from_percent, to_percent);
    const auto above = std::ranges::upper_bound(knots, low);
    return above != knots.end() && *above < high ? std::optional(*above) : std::nullopt;
}

SlotDynamics::Part make_part(const SlotDynamics& dynamics, const LoadSegment& segment, double mechanical_factor) {
    constexpr double longest_step_s = 10.0;
    double max_step_s = std::min(longest_step_s, quick_step_s(segment) / 2.0);
    if (dynamics.circuit.rc_resistance_ohm > 0.0)
        max_step_s = std::min(max_step_s, dynamics.circuit.rc_time_constant_s / 2.0);
    const double duration_s = segment.duration_s();
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / max_step_s * (1.0 - 1e-12))));
    const double step_s = duration_s / static_cast<double>(steps);
    SlotDynamics::Part part{step_s, {dynamics.circuit, step_s}, {}};
    for (std::size_t k = 0; k <= 2 * steps; ++k) {
        const double time_s = segment.start_s + step_s / 2.0 * static_cast<double>(k);
        part.mechanical_w.push_back(mechanical_factor * mechanical_w(segment, time_s));
    }
    return part;
}

SlotDynamics::Slot make_slot(const SlotDynamics& dynamics, const std::vector<LoadSegment>& segments,
                             double mechanical_factor) {
    SlotDynamics::Slot slot;
    slot.min_mechanical_w = std::numeric_limits<double>::infinity();
    slot.max_mechanical_w = -slot.min_mechanical_w;
    for (const auto& segment : segments) {
        slot.duration_s += segment.duration_s();
        slot.parts.push_back(make_part(dynamics, segment, mechanical_factor));
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

StepEnd after_step(CircuitRun& run, const SlotStep& step, const Moment& start) {
    StepEnd after{start};
    auto middle = start;
    middle.power_w = step.power_w.middle;
    after.end.power_w = step.power_w.end;
    run.step(step.length, start, middle, after.end);
    after.middle_percent = middle.soc_percent;
    after.min_v = battery::Parabola{start.terminal_v, middle.terminal_v, after.end.terminal_v}.minimum();
    return after;
}

/// Returns the result of two steps that meet where the charge passes a knot, as the voltage is no parabola beyond it.
/// `above_knot` is the charge above the knot, or below it if the battery is charged.
StepEnd after_knot(const SlotDynamics& dynamics, CircuitRun& run, const SlotStep& step, const Moment& start,
                   const battery::Parabola& above_knot) {
    const auto part_of = [&](double from, double to, const Moment& at) {
        const auto& power_w = step.power_w;
        const double length_s = (to - from) * step.length_s;
        const battery::StepLength length(dynamics.circuit, length_s);
        return after_step(run, {{power_w.at(from), power_w.at((from + to) / 2.0), power_w.at(to)}, length_s, length},
                          at);
    };
    const double knot = std::clamp(above_knot.first_zero_crossing(), 0.0, 1.0);
    if (knot == 0.0 || knot == 1.0) return after_step(run, step, start);
    const auto before = part_of(0.0, knot, start);
    auto after = part_of(knot, 1.0, before.end);
    after.min_v = std::min(before.min_v, after.min_v);
    return after;
}

std::optional<battery::BatteryState> after_part(const SlotDynamics& dynamics, const SlotDynamics::Part& part,
                                                double compute_w, CircuitRun& run, const battery::BatteryState& state) {
    constexpr double rounding_v = 1e-6;
    const double min_v = dynamics.cutoff_voltage_v > 0.0 ? dynamics.cutoff_voltage_v - rounding_v : -1.0;
    const auto power_w = [&](std::size_t k) { return part.mechanical_w[k] + compute_w; };
    Moment now{.soc_percent = state.soc_percent, .rc_voltage_v = state.rc_voltage_v, .power_w = power_w(0)};
    run.complete(now);
    if (now.spare_v2 < 0.0 || now.terminal_v < min_v) return std::nullopt;
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
        if (after.end.spare_v2 < 0.0 || after.min_v < min_v) return std::nullopt;
        now = after.end;
    }
    return battery::BatteryState{now.soc_percent, now.rc_voltage_v};
}

}  // namespace

SlotDynamics make_slot_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                                std::vector<double> compute_w, double mechanical_factor) {
    SlotDynamics dynamics;
    dynamics.circuit = battery::circuit_of(mission.battery);
    dynamics.open_circuit = battery::open_circuit_of(mission.battery);
    dynamics.cutoff_voltage_v = mission.cutoff_voltage_v;
    dynamics.compute_w = std::move(compute_w);
    const auto load = make_mission_load(mission);
    for (const auto& slot : slots)
        dynamics.slots.push_back(make_slot(dynamics, load_segments(load, {slot, {}}), mechanical_factor));
    return dynamics;
}

std::optional<battery::BatteryState> advance_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                  const battery::BatteryState& state) {
    CircuitRun run(dynamics.circuit, battery::VoltageLine(dynamics.open_circuit, state.soc_percent));
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

}  // namespace flightwatt::mission
