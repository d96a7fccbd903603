#include "battery/discharge_lanes.h"

#include <limits>
#include <utility>

namespace flightwatt::battery {
namespace {

using Moments = CircuitMoment<Lanes>;

/// Where something may end within a step. A parabola through three values falls no further below the least of them than
/// an eighth of its bend.
LaneMask find_danger(const Moments& start, const Moments& middle, const Moments& end, double cutoff_v) {
    const auto least = [](const Lanes& a, const Lanes& b, const Lanes& c) -> Lanes {
        return a.min(b).min(c) - 0.125 * (a - 2.0 * b + c).abs();
    };
    Eigen::Array<bool, lane_count, 1> danger =
        end.soc_percent <= 0.0 || least(start.spare_v2, middle.spare_v2, end.spare_v2) < 0.0;
    if (cutoff_v > 0.0) danger = danger || least(start.terminal_v, middle.terminal_v, end.terminal_v) < cutoff_v;
    LaneMask mask;
    if (!danger.any()) return mask;
    for (int lane = 0; lane < lane_count; ++lane) mask[static_cast<std::size_t>(lane)] = danger(lane);
    return mask;
}

void set_lane(RcStep<Lanes>& lanes, int lane, const RcStep<double>& own) {
    lanes.decay(lane) = own.decay;
    lanes.of_first_ohm(lane) = own.of_first_ohm;
    lanes.of_middle_ohm(lane) = own.of_middle_ohm;
    lanes.of_last_ohm(lane) = own.of_last_ohm;
}

/// Of circuits of which some may have an RC pair.
Circuit<Lanes> room_for_circuits() {
    Circuit<Lanes> circuit;
    circuit.rc_resistance_ohm = Lanes::Ones();
    return circuit;
}

}  // namespace

LaneVoltages::LaneVoltages(const OpenCircuitVoltage& curve)
    : knots_percent_(curve.soc_percent), knots_v_(curve.soc_percent.size()) {
    for (int lane = 0; lane < lane_count; ++lane) set_lane(lane, curve);
}

void LaneVoltages::set_lane(int lane, const OpenCircuitVoltage& curve) {
    for (std::size_t k = 0; k < knots_v_.size(); ++k) knots_v_[k](lane) = curve.voltage_v[k];
    low_percent_(lane) = std::numeric_limits<double>::infinity();  // no charge is on a known line
}

Lanes LaneVoltages::operator()(const Lanes& soc_percent) {
    if (((soc_percent < low_percent_) || (soc_percent >= high_percent_)).any()) {
        for (int lane = 0; lane < lane_count; ++lane) {
            const double soc = soc_percent(lane);
            if (soc < low_percent_(lane) || soc >= high_percent_(lane)) find_line(lane, soc);
        }
    }
    return offset_v_ + slope_v_ * soc_percent.max(0.0);
}

void LaneVoltages::find_line(int lane, double soc_percent) {
    const auto knot_v = [&](std::size_t knot) { return knots_v_[knot](lane); };
    const auto segment = find_voltage_segment(knots_percent_, knot_v, soc_percent);
    low_percent_(lane) = segment.low_percent;
    high_percent_(lane) = segment.high_percent;
    offset_v_(lane) = segment.offset_v;
    slope_v_(lane) = segment.slope_v;
}

DischargeLanes::DischargeLanes(const Battery& battery)
    : circuit_(room_for_circuits()),
      run_(circuit_, LaneVoltages(open_circuit_of(battery))),
      length_(circuit_, Lanes::Ones()) {}

void DischargeLanes::set_battery(int lane, const Battery& battery) {
    const auto own = circuit_of(battery);
    circuit_.resistance_ohm(lane) = own.resistance_ohm;
    circuit_.percent_per_as(lane) = own.percent_per_as;
    circuit_.rc_resistance_ohm(lane) = own.rc_resistance_ohm;
    circuit_.rc_time_constant_s(lane) = own.rc_time_constant_s;
    run_.open_circuit().set_lane(lane, battery.thevenin.value().open_circuit);
}

void DischargeLanes::set_state(int lane, const BatteryState& state) {
    moments_[now_].soc_percent(lane) = state.soc_percent;
    moments_[now_].rc_voltage_v(lane) = state.rc_voltage_v;
    is_changed_ = true;
}

void DischargeLanes::set_step(int lane, double length_s) {
    const Circuit<double> circuit{circuit_.resistance_ohm(lane), circuit_.percent_per_as(lane),
                                  circuit_.rc_resistance_ohm(lane), circuit_.rc_time_constant_s(lane)};
    const StepLength<double> own(circuit, length_s);
    length_.percent_per_a(lane) = own.percent_per_a;
    battery::set_lane(length_.half, lane, own.half);
    battery::set_lane(length_.whole, lane, own.whole);
}

LaneMask DischargeLanes::step(const Lanes& start_w, const Lanes& middle_w, const Lanes& end_w,
                              double cutoff_voltage_v) {
    auto& start = moments_[now_];
    now_ = 1 - now_;
    auto& end = moments_[now_];
    if (std::exchange(is_changed_, false)) {
        start.power_w = start_w;
        run_.complete(start);
    }
    middle_.power_w = middle_w;
    end.power_w = end_w;
    run_.step(length_, start, middle_, end);
    return find_danger(start, middle_, end, cutoff_voltage_v);
}

}  // namespace flightwatt::battery
