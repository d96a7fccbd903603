#include "mission/flown_charge.h"

#include "base/units.h"

#include <cmath>

namespace flightwatt::mission {
namespace {

constexpr double coarse_step_s = 1.0;

/// A bound: no harmonic can be more negative than its amplitude.
bool never_charges(const Demand& demand) {
    double least_w = demand.compute_w;
    if (demand.mechanical) {
        const auto& curve = *demand.mechanical;
        least_w += curve.a0_w;
        for (std::size_t n = 0; n < curve.cos_w.size(); ++n) {
            least_w -= std::hypot(curve.cos_w[n], curve.sin_w[n]);
        }
    }
    return least_w >= 0.0;
}

double drained_percent(const battery::Battery& battery, const Demand& demand, double until_s) {
    const double energy_j = mechanical_energy_j(demand, until_s) + compute_energy_j(demand, until_s);
    return units::percent_of(energy_j / battery.voltage_v, units::coulomb_from_ah(battery.capacity_ah));
}

}  // namespace

battery::Discharge after_drop(battery::Discharge state, const Demand& demand) {
    state.soc_percent -= demand.soc_drop_percent;
    if (state.soc_percent <= 0.0) {
        state.soc_percent = 0.0;
        state.empty_at_s = demand.from_s;
    }
    return state;
}

battery::Discharge after_demand(const Mission& mission, const Demand& demand, battery::Discharge state) {
    if (state.ended_at_s() || state.undeliverable) return state;
    if (demand.soc_drop_percent > 0.0) state = after_drop(state, demand);
    if (state.ended_at_s()) return state;
    const auto& battery = mission.battery;
    const bool closed = !battery.thevenin && battery.resistance_ohm == 0.0 &&
                        battery.voltage_v >= mission.cutoff_voltage_v && never_charges(demand);
    if (closed) {
        const double left_percent = state.soc_percent - drained_percent(battery, demand, demand.to_s);
        if (left_percent > 0.0) {
            state.soc_percent = left_percent;
            return state;
        }
    }
    const auto load = [&](double time_s) { return power_w(demand, time_s); };
    return discharge(battery, load, demand.from_s, demand.to_s, state.state(),
                     {coarse_step_s, mission.cutoff_voltage_v});
}

}  // namespace flightwatt::mission
