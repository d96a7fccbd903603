#include "battery/battery_step.h"

#include "base/units.h"

#include <cstddef>

namespace flightwatt::battery {

void VoltageLine::find(double soc_percent) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const auto& [knots, volts] = *curve_;
    const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, soc_percent);
    const auto upper = static_cast<std::size_t>(above - knots.begin());
    low_percent_ = upper == 1 ? -endless : knots[upper - 1];
    high_percent_ = upper + 1 == knots.size() ? endless : knots[upper];
    slope_v_ = (volts[upper] - volts[upper - 1]) / (knots[upper] - knots[upper - 1]);
    offset_v_ = volts[upper - 1] - slope_v_ * knots[upper - 1];
}

Circuit<double> circuit_of(const Battery& battery) {
    Circuit<double> circuit;
    circuit.resistance_ohm = battery.resistance_ohm;
    circuit.percent_per_as = units::percentage(1.0, units::coulomb_from_ah(battery.capacity_ah));
    if (!battery.thevenin || battery.thevenin->rc_resistance_ohm == 0.0) return circuit;
    circuit.rc_resistance_ohm = battery.thevenin->rc_resistance_ohm;
    circuit.rc_time_constant_s = battery.thevenin->rc_time_constant_s;
    return circuit;
}

OpenCircuitVoltage open_circuit_of(const Battery& battery) {
    if (battery.thevenin) return battery.thevenin->open_circuit;
    return {{0.0, units::percent_per_whole}, {battery.voltage_v, battery.voltage_v}};
}

}  // namespace flightwatt::battery
