#include "battery/fast_discharge.h"

#include "base/units.h"
#include "battery/parabola.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace flightwatt::battery {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double end_step_s = 0.5;  // in steps of which an end is looked for
constexpr double parts_of_a_last_step = 16.0;

/// The open-circuit voltage of a charge that only falls.
class FallingVoltage {
  public:
    FallingVoltage(const OpenCircuitVoltage& curve, double soc_percent) : curve_(&curve) {
        const auto above = std::upper_bound(curve.soc_percent.begin() + 1, curve.soc_percent.end() - 1, soc_percent);
        lower_ = static_cast<std::size_t>(above - curve.soc_percent.begin()) - 1;
    }

    double operator()(double soc_percent) {
        const auto& [knots, volts] = *curve_;
        while (lower_ + 2 < knots.size() && soc_percent >= knots[lower_ + 1]) ++lower_;
        while (lower_ > 0 && soc_percent < knots[lower_]) --lower_;
        const double slope = (volts[lower_ + 1] - volts[lower_]) / (knots[lower_ + 1] - knots[lower_]);
        return volts[lower_] + slope * (std::max(soc_percent, 0.0) - knots[lower_]);
    }

  private:
    const OpenCircuitVoltage* curve_;
    std::size_t lower_;
};

/// What is known of the battery at one moment.
struct Moment {
    BatteryState state;
    double power_w = 0.0;
    double current_a = 0.0;
    double terminal_v = 0.0;
    double spare_v2 = 0.0;  ///< below 0 where the power is beyond the limit: U^2 - 4 R P
};

/// Constants of a battery, and its course through one load.
class QuickRun {
  public:
    QuickRun(const Battery& battery, const Load& load, double cutoff_v, double soc_percent)
        : battery_(battery),
          load_(load),
          cutoff_v_(cutoff_v),
          percent_per_as_(units::percentage(1.0, units::coulomb_from_ah(battery.capacity_ah))),
          rc_ohm_(battery.thevenin->rc_resistance_ohm),
          tau_s_(battery.thevenin->rc_time_constant_s),
          voltage_(battery.thevenin->open_circuit, soc_percent) {}

    Moment moment(double time_s, const BatteryState& state) {
        Moment now{.state = state, .power_w = load_.power_w(time_s)};
        const double source_v = std::max(0.0, voltage_(state.soc_percent) - state.rc_voltage_v);
        now.spare_v2 = source_v * source_v - 4.0 * battery_.resistance_ohm * now.power_w;
        if (now.power_w != 0.0) now.current_a = 2.0 * now.power_w / (source_v + std::sqrt(std::max(0.0, now.spare_v2)));
        now.terminal_v = source_v - battery_.resistance_ohm * now.current_a;
        return now;
    }

    struct Step {
        Moment start;
        Moment middle;
        Moment end;
    };
    Step step(double time_s, const Moment& start, double length_s) {
        const double half_s = 0.5 * length_s;
        const RcStep half(rc_ohm_, tau_s_, half_s);
        const RcStep whole(rc_ohm_, tau_s_, length_s);
        const auto evenly = [&](double middle_a) {
            return after(start.state, {start.current_a, std::midpoint(start.current_a, middle_a), middle_a}, half,
                         half_s);
        };
        auto middle = moment(time_s + half_s, evenly(start.current_a));
        middle = moment(time_s + half_s, evenly(middle.current_a));
        const auto curved = [&](double end_a) {
            return after(start.state, {start.current_a, middle.current_a, end_a}, whole, length_s);
        };
        auto end = moment(time_s + length_s, curved(2.0 * middle.current_a - start.current_a));
        end = moment(time_s + length_s, curved(end.current_a));
        return {start, middle, end};
    }

    /// What ends the battery in a step, if anything does.
    std::optional<Discharge> ended(double time_s, const Step& step, double length_s) {
        const auto& start = step.start;
        const auto part_of = [&](double Moment::*value, double least) {
            return Parabola{start.*value - least, step.middle.*value - least, step.end.*value - least}
                .first_zero_crossing();
        };
        const double beyond = part_of(&Moment::spare_v2, 0.0);
        const double cut_off = cutoff_v_ > 0.0 ? part_of(&Moment::terminal_v, cutoff_v_) : never;
        const double empty = step.end.state.soc_percent > 0.0
                                 ? never
                                 : Parabola{start.state.soc_percent, step.middle.state.soc_percent,
                                            std::min(step.end.state.soc_percent, -1e-300)}
                                       .first_zero_crossing();
        const double first = std::min({beyond, cut_off, empty});
        if (first == never) return std::nullopt;
        const double at_s = time_s + first * length_s;
        const auto there = first > 0.0 ? this->step(time_s, start, first * length_s).end : start;
        if (empty == first) return Discharge{{0.0, there.state.rc_voltage_v}, at_s};
        if (cut_off == first) return Discharge{there.state, std::nullopt, at_s};
        return Discharge{there.state, std::nullopt, std::nullopt,
                         Undeliverable{at_s, there.power_w, power_limit_w(battery_, there.state)}};
    }

  private:
    /// The state after a current.
    BatteryState after(const BatteryState& from, const Parabola& current_a, const RcStep& rc, double length_s) const {
        return {from.soc_percent - current_a.mean() * length_s * percent_per_as_,
                rc.voltage_after(from.rc_voltage_v, current_a)};
    }

    const Battery& battery_;
    const Load& load_;
    double cutoff_v_;
    double percent_per_as_;
    double rc_ohm_;
    double tau_s_;
    FallingVoltage voltage_;
};

}  // namespace

// Over longer steps the RC pair's transient is no parabola; what is faster than some seconds hardly counts.
double max_fast_step_s(const TheveninCircuit& circuit, double max_s) {
    constexpr double short_s = 2.0;
    if (circuit.rc_resistance_ohm == 0.0) return max_s;
    return std::min(max_s, std::max(short_s, circuit.rc_time_constant_s));
}

Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& steps) {
    if (!battery.thevenin || !(load.end_s >= load.start_s) || !(steps.max_s > 0.0) ||
        !(state.soc_percent <= units::percent_per_whole) || !(steps.cutoff_voltage_v >= 0.0)) {
        throw std::invalid_argument(
            "quick_discharge: needs a Thevenin circuit, start_s <= end_s, a positive step, at most 100 % and no "
            "negative voltage");
    }
    if (state.soc_percent <= 0.0) return {{0.0, state.rc_voltage_v}, load.start_s};
    const double length_s = load.end_s - load.start_s;
    if (length_s == 0.0) return {state};
    const double max_s = max_fast_step_s(*battery.thevenin, steps.max_s);
    const auto count = static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_s * (1.0 - 1e-12))));
    const double step_s = length_s / static_cast<double>(count);
    QuickRun run(battery, load, steps.cutoff_voltage_v, state.soc_percent);
    auto now = run.moment(load.start_s, state);
    for (std::uint64_t k = 0; k < count; ++k) {
        const double time_s = load.start_s + static_cast<double>(k) * step_s;
        const auto step = run.step(time_s, now, step_s);
        now = step.end;
        const auto end = run.ended(time_s, step, step_s);
        if (!end) continue;
        if (step_s <= end_step_s * (1.0 + 1e-9)) return *end;  // by less the step is not parted any more
        // Looked at closely it may not end.
        const Load rest{load.power_w, time_s, std::min(time_s + step_s, load.end_s)};
        const auto closer =
            fast_discharge(battery, rest, step.start.state,
                           {std::max(end_step_s, step_s / parts_of_a_last_step), steps.cutoff_voltage_v});
        if (closer.ended_at_s() || closer.undeliverable) return closer;
        now = run.moment(rest.end_s, closer);
    }
    return {now.state};
}

}  // namespace flightwatt::battery
