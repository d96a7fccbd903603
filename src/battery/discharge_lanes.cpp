#include "battery/discharge_lanes.h"

#include <limits>
#include <utility>

namespace flightwatt::battery {
namespace {

void set_lane(RcStep<Lanes>& lanes, int lane, const RcStep<double>& own) {
    lanes.decay(lane) = own.decay;
    lanes.of_first_ohm(lane) = own.of_first_ohm;
    lanes.of_middle_ohm(lane) = own.of_middle_ohm;
    lanes.of_last_ohm(lane) = own.of_last_ohm;
}

/// Circuits with RC pairs, for which CircuitRun provides.
Circuit<Lanes> room_for_circuits() {
    Circuit<Lanes> circuit;
    circuit.rc_resistance_ohm = Lanes::Ones();
    return circuit;
}

}  // namespace

LaneVoltages::LaneVoltages(const OpenCircuitVoltage& curve) {
    for (int lane = 0; lane < lane_count; ++lane) set_lane(lane, curve);
}

void LaneVoltages::set_lane(int lane, const OpenCircuitVoltage& curve) {
    curves_.at(static_cast<std::size_t>(lane)) = curve;
    low_percent_(lane) = std::numeric_limits<double>::infinity();  // no cached line
}

Lanes LaneVoltages::operator()(const Lanes& soc_percent) {
    if (((soc_percent < low_percent_) || (soc_percent >= high_percent_)).any()) {
        for (int lane = 0; lane < lane_count; ++lane) {
            const double soc = soc_percent(lane);
            if (soc >= low_percent_(lane) && soc < high_percent_(lane)) continue;
            const auto segment = find_voltage_segment(curves_.at(static_cast<std::size_t>(lane)), soc);
            low_percent_(lane) = segment.low_percent;
            high_percent_(lane) = segment.high_percent;
            offset_v_(lane) = segment.offset_v;
            slope_v_(lane) = segment.slope_v;
        }
    }
    return offset_v_ + slope_v_ * soc_percent.max(0.0);
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
    const Eigen::Array<bool, lane_count, 1> may_end = end_margin(start, middle_, end, cutoff_voltage_v) <= 0.0;
    LaneMask mask;
    if (!may_end.any()) return mask;
    for (int lane = 0; lane < lane_count; ++lane) mask[static_cast<std::size_t>(lane)] = may_end(lane);
    return mask;
}

}  // namespace flightwatt::battery
