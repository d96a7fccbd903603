#include "battery/discharge.h"

#include "base/units.h"
#include "battery/battery_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <Eigen/Core>

namespace flightwatt::battery {
namespace {

constexpr double time_tolerance_s = 1e-10;
constexpr double full_percent = units::percent_per_whole;

/// The battery at one time of a load.
struct LoadedState {
    double time_s = 0.0;
    double power_w = 0.0;
    BatteryState state;
};

/// One step of classic Runge-Kutta.
LoadedState integrate(const Battery& battery, const Load& load, const LoadedState& from, double elapsed_s) {
    using State = Eigen::Vector2d;  // state of charge, voltage of the RC pair
    const auto rate = [&](const State& x, double power_w) {
        const double current_a = limited_current_a(battery, power_w, {x[0], x[1]});
        State per_s(-units::percentage(current_a, units::coulomb_from_ah(battery.capacity_ah)), 0.0);
        if (battery.thevenin)
            per_s[1] = (battery.thevenin->rc_resistance_ohm * current_a - x[1]) / battery.thevenin->rc_time_constant_s;
        return per_s;
    };
    const double middle_w = load.power_w(from.time_s + 0.5 * elapsed_s);
    const double end_w = load.power_w(from.time_s + elapsed_s);
    const State start(from.state.soc_percent, from.state.rc_voltage_v);
    const State k1 = rate(start, from.power_w);
    const State k2 = rate(start + 0.5 * elapsed_s * k1, middle_w);
    const State k3 = rate(start + 0.5 * elapsed_s * k2, middle_w);
    const State k4 = rate(start + elapsed_s * k3, end_w);
    const State end = start + elapsed_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    return {from.time_s + elapsed_s, end_w, {std::min(end[0], full_percent), end[1]}};
}

/// The state, with the reason why the discharge ends there, if it does.
Discharge check_end(const Battery& battery, const LoadedState& at, double cutoff_v) {
    Discharge checked{at.state};
    const double limit_w = power_limit_w(battery, at.state);
    if (at.power_w > limit_w) {
        checked.undeliverable = Undeliverable{at.time_s, at.power_w, limit_w};
    } else if (at.state.soc_percent <= 0.0) {
        checked.soc_percent = 0.0;
        checked.empty_at_s = at.time_s;
    } else if (cutoff_v > 0.0 &&
               terminal_voltage_v(battery, at.state, limited_current_a(battery, at.power_w, at.state)) < cutoff_v) {
        checked.cut_off_at_s = at.time_s;
    }
    return checked;
}

/// The number of steps of fast_discharge: over longer ones than its time constant the RC pair's transient is no parabola;
/// time constants below some seconds have little effect.
std::uint64_t fast_steps(const TheveninCircuit& circuit, double length_s, double max_s) {
    constexpr double short_s = 2.0;
    if (circuit.rc_resistance_ohm > 0.0) max_s = std::min(max_s, std::max(short_s, circuit.rc_time_constant_s));
    return static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_s * (1.0 - 1e-12))));
}

}  // namespace

Discharge discharge(const Battery& battery, const Load& load, const BatteryState& state,
                    const DischargeOptions& options) {
    if (!(load.end_s >= load.start_s) || !(options.max_step_s > 0.0) || !(state.soc_percent <= full_percent) ||
        !(options.cutoff_voltage_v >= 0.0)) {
        throw std::invalid_argument(
            "discharge: needs start_s <= end_s, a positive step, at most 100 % and no negative voltage");
    }
    if (state.soc_percent <= 0.0) return {{0.0, state.rc_voltage_v}, load.start_s};
    double max_step_s = options.max_step_s;
    if (battery.thevenin) max_step_s = std::min(max_step_s, battery.thevenin->rc_time_constant_s / 2.0);
    const double length_s = load.end_s - load.start_s;
    // A quotient a rounding error above a whole number is that number.
    const auto steps = static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_step_s * (1.0 - 1e-12))));
    LoadedState now{load.start_s, load.power_w(load.start_s), state};
    auto result = check_end(battery, now, options.cutoff_voltage_v);
    for (std::uint64_t k = 1; k <= steps && !result.failed_at_s(); ++k) {
        const double fraction = static_cast<double>(k) / static_cast<double>(steps);
        const double next_s = k == steps ? load.end_s : load.start_s + length_s * fraction;
        double after_s = next_s - now.time_s;
        auto next = integrate(battery, load, now, after_s);
        result = check_end(battery, next, options.cutoff_voltage_v);
        for (double before_s = 0.0; result.failed_at_s() && after_s - before_s > time_tolerance_s;) {
            const double middle_s = std::midpoint(before_s, after_s);
            const auto middle = check_end(battery, integrate(battery, load, now, middle_s), options.cutoff_voltage_v);
            if (middle.failed_at_s()) result = middle;
            (middle.failed_at_s() ? after_s : before_s) = middle_s;
        }
        now = {next_s, next.power_w, next.state};
    }
    return result;
}

Discharge fast_discharge(const Battery& battery, const Load& load, const BatteryState& state,
                         const FastDischargeOptions& options) {
    constexpr double exact_step_s = 0.5;
    if (!battery.thevenin || !(load.end_s >= load.start_s) || !(options.max_s > 0.0) ||
        !(state.soc_percent <= units::percent_per_whole) || !(options.cutoff_voltage_v >= 0.0)) {
        throw std::invalid_argument(
            "fast_discharge: needs a Thevenin circuit, start_s <= end_s, a positive step, at most 100 % and no "
            "negative voltage");
    }
    if (state.soc_percent <= 0.0) return {{0.0, state.rc_voltage_v}, load.start_s};
    const double length_s = load.end_s - load.start_s;
    // Constants of an RC pair over much shorter steps than its time constant are differences of near numbers.
    constexpr double min_length_s = 0.01;
    if (length_s < min_length_s) return discharge(battery, load, state, {exact_step_s, options.cutoff_voltage_v});
    const auto count = fast_steps(*battery.thevenin, length_s, options.max_s);
    const double step_s = length_s / static_cast<double>(count);
    const auto circuit = circuit_of(battery);
    CircuitRun run(circuit, VoltageLine(battery.thevenin->open_circuit, state.soc_percent));
    const StepLength length(circuit, step_s);
    CircuitMoment now{
        .soc_percent = state.soc_percent, .rc_voltage_v = state.rc_voltage_v, .power_w = load.power_w(load.start_s)};
    run.complete(now);
    for (std::uint64_t k = 0; k < count; ++k) {
        const double time_s = load.start_s + static_cast<double>(k) * step_s;
        auto middle = now;
        auto end = now;
        middle.power_w = load.power_w(time_s + 0.5 * step_s);
        end.power_w = load.power_w(time_s + step_s);
        run.step(length, now, middle, end);
        if (end_margin(now, middle, end, options.cutoff_voltage_v) <= 0.0) {
            const auto exact = discharge(battery, {load.power_w, time_s, std::min(time_s + step_s, load.end_s)},
                                         {now.soc_percent, now.rc_voltage_v}, {exact_step_s, options.cutoff_voltage_v});
            if (exact.failed_at_s()) return exact;
            end.soc_percent = exact.soc_percent;
            end.rc_voltage_v = exact.rc_voltage_v;
            run.complete(end);
        }
        now = end;
    }
    return {{now.soc_percent, now.rc_voltage_v}};
}

}  // namespace flightwatt::battery
