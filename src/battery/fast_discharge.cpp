#include "battery/fast_discharge.h"

#include "base/units.h"
#include "battery/battery_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace flightwatt::battery {

// Over longer steps the RC pair's transient is no parabola; time constants below some seconds have little effect.
std::uint64_t fast_steps(const TheveninCircuit& circuit, double length_s, double max_s) {
    constexpr double short_s = 2.0;
    if (circuit.rc_resistance_ohm > 0.0) max_s = std::min(max_s, std::max(short_s, circuit.rc_time_constant_s));
    return static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_s * (1.0 - 1e-12))));
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
