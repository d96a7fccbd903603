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

/// The circuit while one choice runs: the line of the open-circuit voltage in which the charge was last seen is
/// remembered.
class SlotCircuit {
  public:
    SlotCircuit(const SlotDynamics& dynamics, double compute_w) : dynamics_(dynamics), compute_w_(compute_w) {}

    /// What a state and a mechanical power lead to.
    struct Load {
        double current_a = 0.0;
        double source_v = 0.0;
        bool is_deliverable = true;
    };

    Load at(const battery::BatteryState& state, double mechanical_w) {
        Load load;
        const double power_w = mechanical_w + compute_w_;
        load.source_v = std::max(0.0, open_circuit_v(state.soc_percent) - state.rc_voltage_v);
        const double discriminant =
            load.source_v * load.source_v - 4.0 * dynamics_.resistance_ohm * power_w;  // of Eq. 27
        load.is_deliverable = discriminant >= -2.0 * dynamics_.error_v * load.source_v;
        const double twice_v = load.source_v + std::sqrt(std::max(0.0, discriminant));
        load.current_a = power_w == 0.0 ? 0.0 : 2.0 * power_w / twice_v;
        return load;
    }

    double terminal_v(const Load& load) const { return load.source_v - dynamics_.resistance_ohm * load.current_a; }

    battery::BatteryState after(const battery::BatteryState& from, const battery::Parabola& current_a,
                                const battery::RcStep& rc, double length_s) const {
        return {from.soc_percent - dynamics_.percent_per_as * length_s * current_a.mean(),
                rc.voltage_after(from.rc_voltage_v, current_a)};
    }

    /// The knot of the open-circuit voltage between two charges, if there is one.
    std::optional<double> knot_between(double from_percent, double to_percent) const {
        const auto& knots = dynamics_.knot_percent;
        const auto [low, high] = std::minmax(from_percent, to_percent);
        const auto above = std::ranges::upper_bound(knots, low);
        return above != knots.end() && *above < high ? std::optional(*above) : std::nullopt;
    }

  private:
    double open_circuit_v(double soc_percent) {
        const auto& knots = dynamics_.knot_percent;
        while (line_ > 0 && soc_percent < knots[line_]) --line_;
        while (line_ + 2 < knots.size() && soc_percent > knots[line_ + 1]) ++line_;
        const double within = std::clamp(soc_percent, knots[line_], knots[line_ + 1]) - knots[line_];
        return dynamics_.knot_v[line_] + dynamics_.slope_v_per_percent[line_] * within;
    }

    const SlotDynamics& dynamics_;
    double compute_w_;
    std::size_t line_ = 0;
};

SlotDynamics::Part part_of(const SlotDynamics& dynamics, const LoadSegment& segment, double longest_step_s,
                           double mechanical_factor) {
    const double duration_s = segment.end_s - segment.start_s;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / longest_step_s * (1.0 - 1e-12))));
    const double step_s = duration_s / static_cast<double>(steps);
    const double ohm = dynamics.rc_resistance_ohm;
    const double constant_s = dynamics.rc_time_constant_s;
    SlotDynamics::Part part{step_s, {ohm, constant_s, step_s / 2.0}, {ohm, constant_s, step_s}, {}};
    part.mechanical_w.resize(2 * steps + 1);
    for (std::size_t k = 0; k < part.mechanical_w.size(); ++k) {
        const double time_s = segment.start_s + part.step_s / 2.0 * static_cast<double>(k);
        part.mechanical_w[k] = mechanical_factor * mechanical_w(segment, time_s);
    }
    return part;
}

SlotDynamics::Slot slot_of(const SlotDynamics& dynamics, const LoadSegment& segment, double step_s,
                           double mechanical_factor) {
    SlotDynamics::Slot slot;
    slot.duration_s = segment.end_s - segment.start_s;
    slot.min_mechanical_w = std::numeric_limits<double>::infinity();
    slot.max_mechanical_w = -slot.min_mechanical_w;
    for (const auto& smooth : split_at_jumps(segment)) {
        slot.parts.push_back(part_of(dynamics, smooth, step_s, mechanical_factor));
        const auto [least, greatest] = std::ranges::minmax_element(slot.parts.back().mechanical_w);
        slot.min_mechanical_w = std::min(slot.min_mechanical_w, *least);
        slot.max_mechanical_w = std::max(slot.max_mechanical_w, *greatest);
    }
    slot.mechanical_energy_j = mechanical_factor * mechanical_energy_j(segment, segment.end_s);
    return slot;
}

void set_circuit(const battery::Battery& battery, SlotDynamics& dynamics) {
    dynamics.resistance_ohm = battery.resistance_ohm;
    dynamics.percent_per_as = units::percentage(1.0, units::coulomb_from_ah(battery.capacity_ah));
    if (battery.thevenin) {
        dynamics.knot_percent = battery.thevenin->open_circuit.soc_percent;
        dynamics.knot_v = battery.thevenin->open_circuit.voltage_v;
        dynamics.rc_resistance_ohm = battery.thevenin->rc_resistance_ohm;
        if (dynamics.rc_resistance_ohm > 0.0) dynamics.rc_time_constant_s = battery.thevenin->rc_time_constant_s;
    } else {
        dynamics.knot_percent = {0.0, units::percent_per_whole};
        dynamics.knot_v = {battery.voltage_v, battery.voltage_v};
    }
    for (std::size_t k = 1; k < dynamics.knot_v.size(); ++k) {
        dynamics.slope_v_per_percent.push_back((dynamics.knot_v[k] - dynamics.knot_v[k - 1]) /
                                               (dynamics.knot_percent[k] - dynamics.knot_percent[k - 1]));
    }
}

/// The battery at one moment, under its load.
struct LoadedState {
    battery::BatteryState state;
    SlotCircuit::Load load;
};

/// A step over which mechanical power is a parabola.
struct SlotStep {
    battery::Parabola mechanical_w;
    double length_s;
    const battery::RcStep& half;
    const battery::RcStep& whole;
};

/// What a step leads to.
struct StepEnd {
    LoadedState end;
    double middle_percent = 0.0;
    double min_v = 0.0;
};

StepEnd after_step(SlotCircuit& circuit, const SlotStep& step, const LoadedState& start) {
    const double start_a = start.load.current_a;
    const auto evenly = [&](double middle_a) {
        return circuit.after(start.state, {start_a, 0.5 * (start_a + middle_a), middle_a}, step.half,
                             step.length_s / 2.0);
    };
    auto middle = circuit.at(evenly(start_a), step.mechanical_w.middle);
    const auto middle_state = evenly(middle.current_a);
    middle = circuit.at(middle_state, step.mechanical_w.middle);
    const auto curved = [&](double end_a) {
        return circuit.after(start.state, {start_a, middle.current_a, end_a}, step.whole, step.length_s);
    };
    StepEnd after;
    const auto guessed = circuit.at(curved(2.0 * middle.current_a - start_a), step.mechanical_w.end);
    after.end.state = curved(guessed.current_a);
    after.end.state.soc_percent = std::min(after.end.state.soc_percent, units::percent_per_whole);
    after.end.load = circuit.at(after.end.state, step.mechanical_w.end);
    after.middle_percent = middle_state.soc_percent;
    after.min_v = battery::Parabola{circuit.terminal_v(start.load), circuit.terminal_v(middle),
                                    circuit.terminal_v(after.end.load)}
                      .minimum();
    return after;
}

/// The same in two steps that meet where the charge passes the knot, as the voltage is no parabola beyond it.
StepEnd after_knot(const SlotDynamics& dynamics, SlotCircuit& circuit, const SlotStep& step, const LoadedState& start,
                   const battery::Parabola& beyond_knot) {
    const auto part_of = [&](double from, double to, const LoadedState& at) {
        const auto& power_w = step.mechanical_w;
        const double length_s = (to - from) * step.length_s;
        const battery::RcStep half(dynamics.rc_resistance_ohm, dynamics.rc_time_constant_s, length_s / 2.0);
        const battery::RcStep whole(dynamics.rc_resistance_ohm, dynamics.rc_time_constant_s, length_s);
        return after_step(
            circuit, {{power_w.at(from), power_w.at((from + to) / 2.0), power_w.at(to)}, length_s, half, whole}, at);
    };
    const double knot = std::clamp(beyond_knot.first_zero_crossing(), 0.0, 1.0);
    if (knot == 0.0 || knot == 1.0) return after_step(circuit, step, start);
    const auto before = part_of(0.0, knot, start);
    auto after = part_of(knot, 1.0, before.end);
    after.min_v = std::min(before.min_v, after.min_v);
    return after;
}

std::optional<battery::BatteryState> after_part(const SlotDynamics& dynamics, const SlotDynamics::Part& part,
                                                SlotCircuit& circuit, const battery::BatteryState& state) {
    constexpr double rounding_v = 1e-6;
    const double cutoff_v = dynamics.cutoff_voltage_v;
    const double min_v = cutoff_v > 0.0 ? cutoff_v - dynamics.error_v - rounding_v : -1.0;
    const auto& power_w = part.mechanical_w;
    LoadedState now{state, circuit.at(state, power_w.front())};
    if (!now.load.is_deliverable || circuit.terminal_v(now.load) < min_v) return std::nullopt;
    for (std::size_t k = 0; k + 1 < power_w.size(); k += 2) {
        const SlotStep step{{power_w[k], power_w[k + 1], power_w[k + 2]}, part.step_s, part.half_step, part.step};
        auto after = after_step(circuit, step, now);
        const double from_percent = now.state.soc_percent;
        const double to_percent = after.end.state.soc_percent;
        if (const auto knot = circuit.knot_between(from_percent, to_percent)) {
            const double sign = from_percent > to_percent ? 1.0 : -1.0;
            after = after_knot(
                dynamics, circuit, step, now,
                {sign * (from_percent - *knot), sign * (after.middle_percent - *knot), sign * (to_percent - *knot)});
        }
        if (!after.end.load.is_deliverable || after.min_v < min_v) return std::nullopt;
        now = after.end;
    }
    return now.state;
}

/// The end of a mission that runs one choice throughout; none if it is not reached.
std::optional<double> end_percent(const SlotDynamics& dynamics, std::size_t choice, double soc_percent) {
    battery::BatteryState state{soc_percent};
    for (std::size_t i = 0; i < dynamics.slots.size(); ++i) {
        const auto after = advance_slot(dynamics, i, choice, state);
        if (!after || after->soc_percent < 0.0) return std::nullopt;
        state = *after;
    }
    return state.soc_percent;
}

MissionSetup without_cut_off(MissionSetup mission) {
    mission.cutoff_voltage_v = 0.0;
    return mission;
}

/// Over longer steps the RC pair's transient is no parabola.
double max_transient_s(const battery::Battery& battery) {
    const bool has_pair = battery.thevenin && battery.thevenin->rc_resistance_ohm > 0.0;
    return has_pair ? battery.thevenin->rc_time_constant_s : std::numeric_limits<double>::infinity();
}

/// Whether missions that run one choice throughout end alike, where they do.
bool agree(const SlotDynamics& a, const SlotDynamics& b, double soc_percent, double within_percent) {
    for (std::size_t choice = 0; choice < a.compute_w.size(); ++choice) {
        const auto end = end_percent(a, choice, soc_percent);
        const auto other = end_percent(b, choice, soc_percent);
        if (end && other && std::abs(*end - *other) > within_percent) return false;
    }
    return true;
}

}  // namespace

SlotDynamics make_slot_dynamics(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                                std::vector<double> compute_w, double step_s, double mechanical_factor) {
    SlotDynamics dynamics;
    set_circuit(mission.battery, dynamics);
    dynamics.cutoff_voltage_v = mission.cutoff_voltage_v;
    dynamics.compute_w = std::move(compute_w);
    const auto load = make_mission_load(mission);
    dynamics.slots.reserve(slots.size());
    for (const auto& slot : slots)
        dynamics.slots.push_back(slot_of(dynamics, load_segment(load, {slot, {}}), step_s, mechanical_factor));
    return dynamics;
}

double choose_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                     const std::vector<double>& compute_w) {
    const auto uncut = without_cut_off(mission);
    double step_s = std::min(max_step_s, max_transient_s(mission.battery) / 2.0);
    const auto [least, most] = std::ranges::minmax_element(compute_w);
    const std::vector<double> extremes{*least, *most};
    auto dynamics = make_slot_dynamics(uncut, slots, extremes, step_s);
    while (step_s > shortest_step_s) {
        auto halved = make_slot_dynamics(uncut, slots, extremes, step_s / 2.0);
        if (agree(dynamics, halved, mission.initial_soc_percent, wanted_agreement_percent)) break;
        step_s /= 2.0;
        dynamics = std::move(halved);
    }
    return step_s;
}

double choose_coarse_step_s(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                            const std::vector<double>& compute_w, double step_s) {
    const auto uncut = without_cut_off(mission);
    const auto [least, most] = std::ranges::minmax_element(compute_w);
    const std::vector<double> extremes{*least, *most};
    const auto exact = make_slot_dynamics(uncut, slots, extremes, step_s);
    double quick_s = step_s;
    const double max_s = std::min(longest_quick_step_s, max_transient_s(mission.battery));
    while (quick_s * 2.0 <= max_s && agree(exact, make_slot_dynamics(uncut, slots, extremes, quick_s * 2.0),
                                           mission.initial_soc_percent, quick_agreement_percent))
        quick_s *= 2.0;
    return quick_s;
}

std::optional<battery::BatteryState> advance_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                  const battery::BatteryState& state) {
    SlotCircuit circuit(dynamics, dynamics.compute_w[choice]);
    std::optional<battery::BatteryState> after = state;
    for (const auto& part : dynamics.slots[slot].parts)
        if (after) after = after_part(dynamics, part, circuit, *after);
    return after;
}

double open_circuit_voltage_v(const SlotDynamics& dynamics, double soc_percent) {
    return SlotCircuit(dynamics, 0.0).at({soc_percent, 0.0}, 0.0).source_v;
}

}  // namespace flightwatt::mission
