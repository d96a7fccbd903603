#include "mission/planning/slot_dynamics.h"

#include "base/units.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::mission {
namespace {

constexpr double longest_step_s = 1.0;
constexpr double shortest_step_s = 0.05;
constexpr double wanted_agreement_percent = 1e-7;
constexpr double longest_quick_step_s = 2.0;
constexpr double quick_agreement_percent = quick_error_percent / 10.0;

/// One slot as it is integrated: the line of the open-circuit voltage in which the charge was last seen is remembered.
class SlotRates {
  public:
    SlotRates(const SlotDynamics& dynamics, double compute_w)
        : dynamics_(dynamics), compute_w_(compute_w), rc_per_s_(1.0 / dynamics.rc_time_constant_s) {}

    /// What a state and a mechanical power lead to.
    struct Rate {
        double percent_per_s = 0.0;
        double rc_v_per_s = 0.0;
        double current_a = 0.0;
        double source_v = 0.0;
        bool is_deliverable = true;
    };

    Rate at(double soc_percent, double rc_v, double mechanical_w) {
        Rate rate;
        const double power_w = mechanical_w + compute_w_;
        rate.source_v = std::max(0.0, open_circuit_v(soc_percent) - rc_v);
        const double discriminant =
            rate.source_v * rate.source_v - 4.0 * dynamics_.resistance_ohm * power_w;  // of Eq. 27
        rate.is_deliverable = discriminant >= -2.0 * dynamics_.error_v * rate.source_v;
        const double twice_v = rate.source_v + std::sqrt(std::max(0.0, discriminant));
        rate.current_a = power_w == 0.0 ? 0.0 : 2.0 * power_w / twice_v;
        rate.percent_per_s = -dynamics_.percent_per_as * rate.current_a;
        rate.rc_v_per_s = (dynamics_.rc_resistance_ohm * rate.current_a - rc_v) * rc_per_s_;
        return rate;
    }

    double terminal_v(const Rate& rate) const { return rate.source_v - dynamics_.resistance_ohm * rate.current_a; }

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
    double rc_per_s_;
    std::size_t line_ = 0;
};

/// Follows the voltage from step to step.
class CutOffWatch {
  public:
    explicit CutOffWatch(double cutoff_v) : limit_v_(cutoff_v > 0.0 ? cutoff_v - rounding_v : -1.0) {}

    void see_middle(double voltage_v) { middle_v_ = voltage_v; }

    /// Whether it fell below the cut-off at the end of a step, or on the parabola through its start, middle and end.
    bool is_cut_off(double end_v) {
        double least_v = end_v;
        const double bend_v = start_v_ - 2.0 * middle_v_ + end_v;
        const double rise_v = end_v - start_v_;
        if (std::abs(rise_v) < 2.0 * bend_v) least_v = middle_v_ - rise_v * rise_v / (8.0 * bend_v);
        start_v_ = middle_v_ = end_v;
        return least_v < limit_v_;
    }

  private:
    static constexpr double rounding_v = 1e-6;
    double limit_v_;
    double start_v_ = NAN;  // before the first step
    double middle_v_ = NAN;
};

SlotDynamics::Part part_of(const LoadSegment& segment, double step_s, double mechanical_factor) {
    SlotDynamics::Part part;
    const double duration_s = segment.end_s - segment.start_s;
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / step_s * (1.0 - 1e-12))));
    part.step_s = duration_s / static_cast<double>(steps);
    part.mechanical_w.resize(2 * steps + 1);
    for (std::size_t k = 0; k < part.mechanical_w.size(); ++k) {
        const double time_s = segment.start_s + part.step_s / 2.0 * static_cast<double>(k);
        part.mechanical_w[k] = mechanical_factor * mechanical_w(segment, time_s);
    }
    return part;
}

SlotDynamics::Slot slot_of(const LoadSegment& segment, double step_s, double mechanical_factor) {
    SlotDynamics::Slot slot;
    slot.duration_s = segment.end_s - segment.start_s;
    slot.least_mechanical_w = std::numeric_limits<double>::infinity();
    slot.greatest_mechanical_w = -slot.least_mechanical_w;
    for (const auto& smooth : smooth_parts(segment)) {
        slot.parts.push_back(part_of(smooth, step_s, mechanical_factor));
        const auto [least, greatest] = std::ranges::minmax_element(slot.parts.back().mechanical_w);
        slot.least_mechanical_w = std::min(slot.least_mechanical_w, *least);
        slot.greatest_mechanical_w = std::max(slot.greatest_mechanical_w, *greatest);
    }
    slot.mechanical_energy_j = mechanical_factor * mechanical_energy_j(segment, segment.end_s);
    return slot;
}

void set_circuit(const battery::Battery& battery, SlotDynamics& dynamics) {
    dynamics.resistance_ohm = battery.resistance_ohm;
    dynamics.percent_per_as = units::percent_of(1.0, units::coulomb_from_ah(battery.capacity_ah));
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

std::optional<battery::BatteryState> after_part(const SlotDynamics& dynamics, const SlotDynamics::Part& part,
                                                SlotRates& rates, const battery::BatteryState& state) {
    const double step_s = part.step_s;
    const auto& mechanical_w = part.mechanical_w;
    CutOffWatch watch(dynamics.cutoff_voltage_v - dynamics.error_v);
    double soc = state.soc_percent;
    double rc = state.rc_voltage_v;
    for (std::size_t k = 0;; k += 2) {
        const auto first = rates.at(soc, rc, mechanical_w[k]);
        if (!first.is_deliverable || watch.is_cut_off(rates.terminal_v(first))) return std::nullopt;
        if (k + 1 == mechanical_w.size()) return battery::BatteryState{soc, rc};
        const double half_s = step_s / 2.0;
        const double middle_w = mechanical_w[k + 1];
        const auto second = rates.at(soc + half_s * first.percent_per_s, rc + half_s * first.rc_v_per_s, middle_w);
        const auto third = rates.at(soc + half_s * second.percent_per_s, rc + half_s * second.rc_v_per_s, middle_w);
        const auto fourth =
            rates.at(soc + step_s * third.percent_per_s, rc + step_s * third.rc_v_per_s, mechanical_w[k + 2]);
        watch.see_middle(rates.terminal_v(third));
        soc += step_s / 6.0 *
               (first.percent_per_s + 2.0 * (second.percent_per_s + third.percent_per_s) + fourth.percent_per_s);
        rc += step_s / 6.0 * (first.rc_v_per_s + 2.0 * (second.rc_v_per_s + third.rc_v_per_s) + fourth.rc_v_per_s);
        soc = std::min(soc, units::percent_per_whole);
    }
}

/// The end of a mission that runs one choice throughout; none if it is not reached.
std::optional<double> end_percent(const SlotDynamics& dynamics, std::size_t choice, double soc_percent) {
    battery::BatteryState state{soc_percent};
    for (std::size_t i = 0; i < dynamics.slots.size(); ++i) {
        const auto after = after_slot(dynamics, i, choice, state);
        if (!after || after->soc_percent < 0.0) return std::nullopt;
        state = *after;
    }
    return state.soc_percent;
}

MissionSetup without_cut_off(MissionSetup mission) {
    mission.cutoff_voltage_v = 0.0;
    return mission;
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
    const auto load = load_of(mission);
    dynamics.slots.reserve(slots.size());
    for (const auto& slot : slots)
        dynamics.slots.push_back(slot_of(load_segment(load, {slot, {}}), step_s, mechanical_factor));
    return dynamics;
}

double step_for(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                const std::vector<double>& compute_w) {
    const auto uncut = without_cut_off(mission);
    double step_s = longest_step_s;
    if (mission.battery.thevenin && mission.battery.thevenin->rc_resistance_ohm > 0.0)
        step_s = std::min(step_s, mission.battery.thevenin->rc_time_constant_s / 2.0);
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

double quick_step_for(const MissionSetup& mission, const std::vector<PhaseSegment>& slots,
                      const std::vector<double>& compute_w, double step_s) {
    const auto uncut = without_cut_off(mission);
    const auto [least, most] = std::ranges::minmax_element(compute_w);
    const std::vector<double> extremes{*least, *most};
    const auto exact = make_slot_dynamics(uncut, slots, extremes, step_s);
    double quick_s = step_s;
    while (quick_s * 2.0 <= longest_quick_step_s &&
           agree(exact, make_slot_dynamics(uncut, slots, extremes, quick_s * 2.0), mission.initial_soc_percent,
                 quick_agreement_percent))
        quick_s *= 2.0;
    return quick_s;
}

std::optional<battery::BatteryState> after_slot(const SlotDynamics& dynamics, std::size_t slot, std::size_t choice,
                                                const battery::BatteryState& state) {
    SlotRates rates(dynamics, dynamics.compute_w[choice]);
    std::optional<battery::BatteryState> after = state;
    for (const auto& part : dynamics.slots[slot].parts)
        if (after) after = after_part(dynamics, part, rates, *after);
    return after;
}

double open_circuit_voltage_v(const SlotDynamics& dynamics, double soc_percent) {
    return SlotRates(dynamics, 0.0).at(soc_percent, 0.0, 0.0).source_v;
}

}  // namespace flightwatt::mission
