#include "battery/discharge_lanes.h"

#include <stdexcept>
#include <utility>

namespace flightwatt::battery {
namespace {

/// The open-circuit voltages of charges that mostly fall: each lane remembers the line that it is on.
class FallingVoltages {
  public:
    FallingVoltages(const BatteryLanes& batteries, const Lanes& soc_percent) : batteries_(batteries) {
        for (int lane = 0; lane < lane_count; ++lane) find_line(lane, soc_percent(lane));
    }

    Lanes operator()(const Lanes& soc_percent) {
        if (((soc_percent < low_percent_) || (soc_percent >= high_percent_)).any()) {
            for (int lane = 0; lane < lane_count; ++lane) {
                const double soc = soc_percent(lane);
                if (soc < low_percent_(lane) || soc >= high_percent_(lane)) find_line(lane, soc);
            }
        }
        return offset_v_ + slope_v_ * soc_percent.max(0.0);
    }

  private:
    void find_line(int lane, double soc_percent) {
        const auto knot_v = [&](std::size_t knot) { return batteries_.knots_v[knot](lane); };
        const auto segment = find_voltage_segment(batteries_.knots_percent, knot_v, soc_percent);
        low_percent_(lane) = segment.low_percent;
        high_percent_(lane) = segment.high_percent;
        offset_v_(lane) = segment.offset_v;
        slope_v_(lane) = segment.slope_v;
    }

    const BatteryLanes& batteries_;
    Lanes low_percent_;
    Lanes high_percent_;
    Lanes offset_v_;
    Lanes slope_v_;
};

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

}  // namespace

BatteryLanes make_lanes(const Battery& battery) {
    if (!battery.thevenin) throw std::invalid_argument("make_lanes: needs a Thevenin circuit");
    BatteryLanes lanes;
    lanes.knots_percent = battery.thevenin->open_circuit.soc_percent;
    lanes.knots_v.resize(lanes.knots_percent.size());
    for (int lane = 0; lane < lane_count; ++lane) set_lane(lanes, lane, battery);
    return lanes;
}

void set_lane(BatteryLanes& lanes, int lane, const Battery& battery) {
    const auto own = circuit_of(battery);
    lanes.circuit.resistance_ohm(lane) = own.resistance_ohm;
    lanes.circuit.percent_per_as(lane) = own.percent_per_as;
    lanes.circuit.rc_resistance_ohm(lane) = own.rc_resistance_ohm;
    lanes.circuit.rc_time_constant_s(lane) = own.rc_time_constant_s;
    for (std::size_t k = 0; k < lanes.knots_v.size(); ++k)
        lanes.knots_v[k](lane) = battery.thevenin->open_circuit.voltage_v[k];
}

void discharge_lanes(const BatteryLanes& batteries, const LoadLanes& load, double cutoff_voltage_v,
                     const StepResolver& resolve_step, StateLanes& state) {
    CircuitRun<Lanes, FallingVoltages> run(batteries.circuit, FallingVoltages(batteries, state.soc_percent));
    const StepLength<Lanes> length(batteries.circuit, Lanes(load.length_s / static_cast<double>(load.steps)));
    Moments start;
    start.soc_percent = state.soc_percent;
    start.rc_voltage_v = state.rc_voltage_v;
    Moments middle = start;
    Moments end = start;
    load.power_w(0, start.power_w);
    run.complete(start);
    for (std::size_t k = 0; k < load.steps && state.is_active.any(); ++k) {
        load.power_w(2 * k + 1, middle.power_w);
        load.power_w(2 * k + 2, end.power_w);
        run.step(length, start, middle, end);
        if (const auto danger = find_danger(start, middle, end, cutoff_voltage_v) & state.is_active; danger.any()) {
            for (std::size_t i = 0; i < lane_count; ++i) {
                if (!danger[i]) continue;
                const int lane = static_cast<int>(i);
                BatteryState now{start.soc_percent(lane), start.rc_voltage_v(lane)};
                state.is_active[i] = resolve_step(lane, k, now);
                end.soc_percent(lane) = now.soc_percent;
                end.rc_voltage_v(lane) = now.rc_voltage_v;
            }
            run.complete(end);
        }
        std::swap(start, end);
    }
    state.soc_percent = start.soc_percent;
    state.rc_voltage_v = start.rc_voltage_v;
}

}  // namespace flightwatt::battery
