#include "battery/battery_step.h"

#include "base/units.h"

namespace flightwatt::battery {

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
