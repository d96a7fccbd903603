#include "battery/discharge_lanes.h"

#include "base/units.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace flightwatt::battery {
namespace {

/// The open-circuit voltages of charges that mostly fall: each lane remembers the line that it is on.
class FallingVoltages {
  public:
    FallingVoltages(const BatteryLanes& batteries, const Lanes& soc_percent) : batteries_(batteries) {
        for (int lane = 0; lane < lane_count; ++lane) find_line(lane, soc_percent(lane));
    }

    void at(const Lanes& soc_percent, Lanes& voltage_v) {
        if (((soc_percent < low_percent_) || (soc_percent >= high_percent_)).any()) {
            for (int lane = 0; lane < lane_count; ++lane) {
                const double soc = soc_percent(lane);
                if (soc < low_percent_(lane) || soc >= high_percent_(lane)) find_line(lane, soc);
            }
        }
        voltage_v = offset_v_ + slope_v_ * soc_percent.max(0.0);
    }

  private:
    void find_line(int lane, double soc_percent) {
        constexpr double endless = std::numeric_limits<double>::infinity();
        const auto& knots = batteries_.knots_percent;
        const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, soc_percent);
        const auto lower = static_cast<std::size_t>(above - knots.begin()) - 1;
        low_percent_(lane) = lower == 0 ? -endless : knots[lower];
        high_percent_(lane) = lower + 2 == knots.size() ? endless : knots[lower + 1];
        const double low_v = batteries_.knots_v[lower](lane);
        const double rise_v = batteries_.knots_v[lower + 1](lane) - low_v;
        slope_v_(lane) = rise_v / (knots[lower + 1] - knots[lower]);
        offset_v_(lane) = low_v - slope_v_(lane) * knots[lower];
    }

    const BatteryLanes& batteries_;
    Lanes low_percent_;
    Lanes high_percent_;
    Lanes offset_v_;
    Lanes slope_v_;
};

/// What is known of the batteries at one moment; spare_v2 as in quick_discharge.cpp.
struct Moments {
    Lanes soc_percent = Lanes::Zero();
    Lanes rc_voltage_v = Lanes::Zero();
    Lanes power_w = Lanes::Zero();
    Lanes current_a = Lanes::Zero();
    Lanes terminal_v = Lanes::Zero();
    Lanes spare_v2 = Lanes::Zero();
};

/// RC pairs over a step, as RcStep: what a current that is a parabola leaves of them is linear in its three values.
struct RcSteps {
    RcSteps(const BatteryLanes& batteries, const Lanes& length_s)
        : decay((-length_s / batteries.rc_time_constant_s).exp()) {
        const Lanes c = batteries.rc_time_constant_s / length_s;
        const Lanes& ohm = batteries.rc_resistance_ohm;
        const auto of_current = [&](double first_a, double middle_a, double last_a) -> Lanes {
            const double curvature = 2.0 * (first_a - 2.0 * middle_a + last_a);
            const double slope = 4.0 * middle_a - 3.0 * first_a - last_a;
            const Lanes bent = 2.0 * curvature * c * c;
            const Lanes first_v = first_a - c * slope + bent;
            const Lanes last_v = last_a - c * (slope + 2.0 * curvature) + bent;
            return ohm * (last_v - first_v * decay);
        };
        of_first_ohm = of_current(1.0, 0.0, 0.0);
        of_middle_ohm = of_current(0.0, 1.0, 0.0);
        of_last_ohm = of_current(0.0, 0.0, 1.0);
    }

    Lanes decay;
    Lanes of_first_ohm;
    Lanes of_middle_ohm;
    Lanes of_last_ohm;
};

class LanesRun {
  public:
    LanesRun(const BatteryLanes& batteries, const LoadLanes& load, double cutoff_v, const StateLanes& state)
        : batteries_(batteries),
          cutoff_v_(cutoff_v),
          four_ohm_(4.0 * batteries.resistance_ohm),
          whole_percent_per_a_(batteries.percent_per_as * load.length_s / static_cast<double>(load.steps) / 6.0),
          has_rc_((batteries.rc_resistance_ohm > 0.0).any()),
          half_(batteries, load.length_s / static_cast<double>(2 * load.steps)),
          whole_(batteries, load.length_s / static_cast<double>(load.steps)),
          voltages_(batteries, state.soc_percent) {}

    /// The rest of a moment whose charge, RC voltage and power are known.
    void complete(Moments& now) {
        constexpr double min_v = 1e-300;  // no 0 / 0 of what draws nothing
        voltages_.at(now.soc_percent, source_v_);
        source_v_ = (source_v_ - now.rc_voltage_v).max(0.0);
        now.spare_v2 = source_v_ * source_v_ - four_ohm_ * now.power_w;
        now.current_a = 2.0 * now.power_w / (source_v_ + now.spare_v2.max(0.0).sqrt()).max(min_v);
        now.terminal_v = source_v_ - batteries_.resistance_ohm * now.current_a;
    }

    /// A step from its start; the powers at its middle and end are known. As in quick_discharge.cpp.
    void step(const Moments& start, Moments& middle, Moments& end) {
        evenly(start, start.current_a, middle);
        complete(middle);
        evenly(start, Lanes(middle.current_a), middle);
        complete(middle);
        curved(start, middle.current_a, 2.0 * middle.current_a - start.current_a, end);
        complete(end);
        curved(start, middle.current_a, Lanes(end.current_a), end);
        complete(end);
    }

    /// Where something may end within a step. A parabola through three values falls no further below the least of them
    /// than an eighth of its bend.
    LaneMask in_danger(const Moments& start, const Moments& middle, const Moments& end) const {
        const auto least = [](const Lanes& a, const Lanes& b, const Lanes& c) -> Lanes {
            return a.min(b).min(c) - 0.125 * (a - 2.0 * b + c).abs();
        };
        Eigen::Array<bool, lane_count, 1> danger =
            end.soc_percent <= 0.0 || least(start.spare_v2, middle.spare_v2, end.spare_v2) < 0.0;
        if (cutoff_v_ > 0.0) danger = danger || least(start.terminal_v, middle.terminal_v, end.terminal_v) < cutoff_v_;
        LaneMask mask;
        if (!danger.any()) return mask;
        for (int lane = 0; lane < lane_count; ++lane) mask[static_cast<std::size_t>(lane)] = danger(lane);
        return mask;
    }

  private:
    /// Half a step, along whose current rises evenly to the middle.
    void evenly(const Moments& start, const Lanes& middle_a, Moments& middle) const {
        middle.soc_percent = start.soc_percent - 1.5 * whole_percent_per_a_ * (start.current_a + middle_a);
        if (!has_rc_) return;
        middle.rc_voltage_v = start.rc_voltage_v * half_.decay +
                              (half_.of_first_ohm + 0.5 * half_.of_middle_ohm) * start.current_a +
                              (half_.of_last_ohm + 0.5 * half_.of_middle_ohm) * middle_a;
    }

    void curved(const Moments& start, const Lanes& middle_a, const Lanes& end_a, Moments& end) const {
        end.soc_percent = start.soc_percent - whole_percent_per_a_ * (start.current_a + 4.0 * middle_a + end_a);
        if (!has_rc_) return;
        end.rc_voltage_v = start.rc_voltage_v * whole_.decay + whole_.of_first_ohm * start.current_a +
                           whole_.of_middle_ohm * middle_a + whole_.of_last_ohm * end_a;
    }

    const BatteryLanes& batteries_;
    double cutoff_v_;
    Lanes four_ohm_;
    Lanes whole_percent_per_a_;  ///< of a step, for each of Simpson's six parts
    bool has_rc_;
    RcSteps half_;
    RcSteps whole_;
    FallingVoltages voltages_;
    Lanes source_v_;
};

}  // namespace

BatteryLanes make_lanes(const Battery& battery) {
    if (!battery.thevenin) throw std::invalid_argument("lanes_like: needs a Thevenin circuit");
    BatteryLanes lanes;
    lanes.knots_percent = battery.thevenin->open_circuit.soc_percent;
    lanes.knots_v.resize(lanes.knots_percent.size());
    for (int lane = 0; lane < lane_count; ++lane) set_lane(lanes, lane, battery);
    return lanes;
}

void set_lane(BatteryLanes& lanes, int lane, const Battery& battery) {
    const auto& circuit = *battery.thevenin;
    lanes.resistance_ohm(lane) = battery.resistance_ohm;
    lanes.percent_per_as(lane) = units::percentage(1.0, units::coulomb_from_ah(battery.capacity_ah));
    lanes.rc_resistance_ohm(lane) = circuit.rc_resistance_ohm;
    lanes.rc_time_constant_s(lane) = circuit.rc_time_constant_s;
    for (std::size_t k = 0; k < lanes.knots_v.size(); ++k) lanes.knots_v[k](lane) = circuit.open_circuit.voltage_v[k];
}

void discharge_lanes(const BatteryLanes& batteries, const LoadLanes& load, double cutoff_voltage_v,
                     const StepResolver& resolve_step, StateLanes& state) {
    LanesRun run(batteries, load, cutoff_voltage_v, state);
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
        run.step(start, middle, end);
        if (const auto danger = run.in_danger(start, middle, end) & state.is_active; danger.any()) {
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
