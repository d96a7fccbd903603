#include "mission/simulation/segment_discharge.h"

#include "base/units.h"

#include <cmath>

namespace flightwatt::mission {
namespace {

constexpr double coarse_step_s = 1.0;

/// A bound: no harmonic can be more negative than its amplitude.
bool never_charges(const LoadSegment& segment) {
    double least_w = segment.compute_w;
    if (segment.mechanical) {
        const auto& curve = *segment.mechanical;
        least_w += curve.a0_w;
        for (std::size_t n = 0; n < curve.cos_w.size(); ++n) {
            least_w -= std::hypot(curve.cos_w[n], curve.sin_w[n]);
        }
    }
    return least_w >= 0.0;
}

double depleted_percent(const battery::Battery& battery, const LoadSegment& segment, double until_s) {
    const double energy_j = mechanical_energy_j(segment, until_s) + compute_energy_j(segment, until_s);
    return units::percent_of(energy_j / battery.voltage_v, units::coulomb_from_ah(battery.capacity_ah));
}

}  // namespace

battery::Discharge after_drop(battery::Discharge state, const LoadSegment& segment) {
    state.soc_percent -= segment.soc_drop_percent;
    if (state.soc_percent <= 0.0) {
        state.soc_percent = 0.0;
        state.empty_at_s = segment.start_s;
    }
    return state;
}

battery::Discharge after_segment(const battery::Battery& battery, double cutoff_voltage_v,
                                 const LoadSegment& segment, battery::Discharge state) {
    if (state.ended_at_s() || state.undeliverable) return state;
    if (segment.soc_drop_percent > 0.0) state = after_drop(state, segment);
    if (state.ended_at_s()) return state;
    const bool closed = !battery.thevenin && battery.resistance_ohm == 0.0 &&
                        battery.voltage_v >= cutoff_voltage_v && never_charges(segment);
    if (closed) {
        const double left_percent = state.soc_percent - depleted_percent(battery, segment, segment.end_s);
        if (left_percent > 0.0) {
            state.soc_percent = left_percent;
            return state;
        }
    }
    const auto load = [&](double time_s) { return power_w(segment, time_s); };
    return discharge(battery, load, segment.start_s, segment.end_s, state.state(),
                     {coarse_step_s, cutoff_voltage_v});
}

}  // namespace flightwatt::mission
