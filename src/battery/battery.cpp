#include "battery/battery.h"

#include "base/piecewise_linear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::battery {

double full_energy_wh(const Battery& battery) {
    if (!battery.thevenin) return battery.capacity_ah * battery.voltage_v;
    const auto& [soc_percent, voltage_v] = battery.thevenin->open_circuit;
    double percent_v = 0.0;
    for (std::size_t i = 1; i < soc_percent.size(); ++i)
        percent_v += (soc_percent[i] - soc_percent[i - 1]) * std::midpoint(voltage_v[i - 1], voltage_v[i]);
    return battery.capacity_ah * percent_v / (soc_percent.back() - soc_percent.front());
}

double open_circuit_voltage_v(const Battery& battery, double soc_percent) {
    if (!battery.thevenin) return battery.voltage_v;
    const auto& curve = battery.thevenin->open_circuit;
    return interpolate_clamped(curve.soc_percent, curve.voltage_v, soc_percent);
}

double source_voltage_v(const Battery& battery, const BatteryState& state) {
    return open_circuit_voltage_v(battery, state.soc_percent) - state.rc_voltage_v;
}

double terminal_voltage_v(const Battery& battery, const BatteryState& state, double current_a) {
    return source_voltage_v(battery, state) - battery.resistance_ohm * current_a;
}

double power_limit_w(const Battery& battery, const BatteryState& state) {
    const double voltage_v = source_voltage_v(battery, state);
    if (voltage_v <= 0.0) return 0.0;
    if (battery.resistance_ohm == 0.0) return std::numeric_limits<double>::infinity();
    return voltage_v * voltage_v / (4.0 * battery.resistance_ohm);
}

double internal_current_a(const Battery& battery, double power_w, const BatteryState& state) {
    const double limit_w = power_limit_w(battery, state);
    if (power_w > limit_w) {
        throw NoAnswerError(
            fmt::format("the battery cannot deliver {} W: its limit U^2 / (4 R) is {} W", power_w, limit_w));
    }
    if (power_w == 0.0) return 0.0;
    const double u = std::max(0.0, source_voltage_v(battery, state));
    // (U - sqrt(D)) / (2 R), multiplied out: no difference of near numbers, no division by R. At the limit
    // rounding may leave D a hair below zero.
    const double discriminant = std::max(0.0, u * u - 4.0 * battery.resistance_ohm * power_w);
    return 2.0 * power_w / (u + std::sqrt(discriminant));
}

}  // namespace flightwatt::battery
