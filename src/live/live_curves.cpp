#include "live/live_curves.h"

#include "battery/discharge.h"

#include <algorithm>

namespace flightwatt::live {
TimeCurve soc_ahead(const LiveState& state, const PredictionInput& basis) {
    constexpr double max_points = 100.0;
    constexpr double finest_s = 10.0;
    constexpr double integration_s = 5.0;
    TimeCurve curve;
    if (!state.prediction || !basis.battery || !state.battery || !state.battery->state) return curve;
    const auto stretches = remaining_power(*state.prediction);
    double rest_s = 0.0;
    for (const auto& stretch : stretches) rest_s += stretch.duration_s;
    const double step_s = std::max(finest_s, rest_s / max_points);
    battery::BatteryState now = *state.battery->state;
    double time_s = state.time_s;
    curve = {{time_s}, {now.soc_percent}};
    for (const auto& stretch : stretches) {
        for (double left_s = stretch.duration_s; left_s > 0.0;) {
            const double part_s = std::min(left_s, step_s);
            const double power_w = stretch.power_w;
            const auto end = discharge(*basis.battery, {[power_w](double) { return power_w; }, 0.0, part_s}, now,
                                       {integration_s, basis.limits.cutoff_voltage_v});
            if (end.ended_at_s() || end.undeliverable) return curve;
            now = end;
            left_s -= part_s;
            time_s += part_s;
            curve.time_s.push_back(time_s);
            curve.value.push_back(now.soc_percent);
        }
    }
    return curve;
}

}  // namespace flightwatt::live
