#include "battery/fast_discharge.h"

#include "base/units.h"
#include "battery/battery_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace flightwatt::battery {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double end_step_s = 0.5;  // in steps of which an end is looked for
constexpr double parts_of_a_last_step = 16.0;

using Moment = CircuitMoment<double>;

BatteryState state_of(const Moment& moment) { return {moment.soc_percent, moment.rc_voltage_v}; }

/// A battery's course through one load.
class FastRun {
  public:
    FastRun(const Battery& battery, const Load& load, double cutoff_v, double soc_percent)
        : battery_(battery),
          load_(load),
          cutoff_v_(cutoff_v),
          circuit_(circuit_of(battery)),
          run_(circuit_, VoltageLine(battery.thevenin->open_circuit, soc_percent)) {}

    const Circuit<double>& circuit() const { return circuit_; }

    Moment moment(double time_s, const BatteryState& state) {
        Moment now{.soc_percent = state.soc_percent, .rc_voltage_v = state.rc_voltage_v};
        now.power_w = load_.power_w(time_s);
        run_.complete(now);
        return now;
    }

    struct Step {
        Moment start;
        Moment middle;
        Moment end;
    };
    Step step(double time_s, const Moment& start, const StepLength<double>& length, double length_s) {
        Step step{start, start, start};
        step.middle.power_w = load_.power_w(time_s + 0.5 * length_s);
        step.end.power_w = load_.power_w(time_s + length_s);
        run_.step(length, start, step.middle, step.end);
        return step;
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
        const double empty = step.end.soc_percent > 0.0 ? never
                                                        : Parabola{start.soc_percent, step.middle.soc_percent,
                                                                   std::min(step.end.soc_percent, -1e-300)}
                                                              .first_zero_crossing();
        const double first = std::min({beyond, cut_off, empty});
        if (first == never) return std::nullopt;
        const double at_s = time_s + first * length_s;
        const auto there = first > 0.0 ? shortened(time_s, start, first * length_s) : start;
        if (empty == first) return Discharge{{0.0, there.rc_voltage_v}, at_s};
        if (cut_off == first) return Discharge{state_of(there), std::nullopt, at_s};
        return Discharge{state_of(there), std::nullopt, std::nullopt,
                         Undeliverable{at_s, there.power_w, power_limit_w(battery_, state_of(there))}};
    }

  private:
    Moment shortened(double time_s, const Moment& start, double length_s) {
        return step(time_s, start, StepLength<double>(circuit_, length_s), length_s).end;
    }

    const Battery& battery_;
    const Load& load_;
    double cutoff_v_;
    Circuit<double> circuit_;
    CircuitRun<double, VoltageLine> run_;
};

}  // namespace

// Over longer steps the RC pair's transient is no parabola; what is faster than some seconds hardly counts.
std::uint64_t fast_steps(const TheveninCircuit& circuit, double length_s, double max_s) {
    constexpr double short_s = 2.0;
    if (circuit.rc_resistance_ohm > 0.0) max_s = std::min(max_s, std::max(short_s, circuit.rc_time_constant_s));
    return static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_s * (1.0 - 1e-12))));
}

Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& steps) {
    if (!battery.thevenin || !(load.end_s >= load.start_s) || !(steps.max_s > 0.0) ||
        !(state.soc_percent <= units::percent_per_whole) || !(steps.cutoff_voltage_v >= 0.0)) {
        throw std::invalid_argument(
            "fast_discharge: needs a Thevenin circuit, start_s <= end_s, a positive step, at most 100 % and no "
            "negative voltage");
    }
    if (state.soc_percent <= 0.0) return {{0.0, state.rc_voltage_v}, load.start_s};
    const double length_s = load.end_s - load.start_s;
    if (length_s == 0.0) return {state};
    const auto count = fast_steps(*battery.thevenin, length_s, steps.max_s);
    const double step_s = length_s / static_cast<double>(count);
    FastRun run(battery, load, steps.cutoff_voltage_v, state.soc_percent);
    const StepLength<double> length(run.circuit(), step_s);
    auto now = run.moment(load.start_s, state);
    for (std::uint64_t k = 0; k < count; ++k) {
        const double time_s = load.start_s + static_cast<double>(k) * step_s;
        const auto step = run.step(time_s, now, length, step_s);
        now = step.end;
        const auto end = run.ended(time_s, step, step_s);
        if (!end) continue;
        if (step_s <= end_step_s * (1.0 + 1e-9)) return *end;  // by less the step is not parted any more
        // Looked at closely it may not end.
        const Load rest{load.power_w, time_s, std::min(time_s + step_s, load.end_s)};
        const auto closer =
            fast_discharge(battery, rest, state_of(step.start),
                           {std::max(end_step_s, step_s / parts_of_a_last_step), steps.cutoff_voltage_v});
        if (closer.ended_at_s() || closer.undeliverable) return closer;
        now = run.moment(rest.end_s, closer);
    }
    return {state_of(now)};
}

}  // namespace flightwatt::battery
