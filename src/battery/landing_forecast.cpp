#include "battery/landing_forecast.h"

#include "base/error.h"
#include "base/number.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double max_s = 86400.0;     // of an endurance
constexpr double exact_step_s = 5.0;  // of Runge-Kutta under constant power: charge and voltage are nearly linear
constexpr double fast_step_s = 20.0;

/// Time until the battery fails or only its reserve is left under a constant power.
double compute_endurance_s(const Battery& battery, const BatteryState& state, double power_w,
                           const LandingLimits& limits) {
    if (!(power_w > 0.0) || state.soc_percent <= limits.reserve_soc_percent) return 0.0;
    constexpr int bisections = 40;
    // The load cannot draw more energy than a full battery holds.
    const double high_s = std::min(max_s, units::joule_from_wh(full_energy_wh(battery)) / power_w);
    return last_true(0.0, high_s, bisections, [&](double duration_s) {
        const auto end = discharge_constant_load(battery, state, {power_w, duration_s}, limits.cutoff_voltage_v);
        return !end.failed_at_s() && end.soc_percent >= limits.reserve_soc_percent;
    });
}

}  // namespace

double resting_soc_percent(const Battery& battery, double voltage_v) {
    const auto& curve = battery.thevenin.value().open_circuit;
    return interpolate_clamped(curve.voltage_v, curve.soc_percent, voltage_v);
}

double resting_soc_sd_percent(const Battery& battery, double voltage_v) {
    constexpr double lipo_cell_v = 4.2;
    constexpr double span_percent = 10.0;  // of the slope
    constexpr double min_fall_v = 0.01;
    const auto& [knots_percent, knots_v] = battery.thevenin.value().open_circuit;
    const double full_v = open_circuit_voltage_v(battery, units::percent_per_whole);
    const double cells = battery.cells.value_or(static_cast<int>(std::round(full_v / lipo_cell_v)));
    const double soc_percent = resting_soc_percent(battery, voltage_v);
    const auto& errors_v = battery.intervals.open_circuit_standard_error_v;
    const double curve_v = errors_v.empty() ? 0.0 : interpolate_clamped(knots_percent, errors_v, soc_percent);
    const double sd_v =
        std::hypot(cells * charged_rest_sd_v, lower_rest_fraction * std::max(0.0, full_v - voltage_v), curve_v);
    const double from_percent = std::max(0.0, soc_percent - span_percent);
    const double fall_v =
        open_circuit_voltage_v(battery, from_percent + span_percent) - open_circuit_voltage_v(battery, from_percent);
    return std::min(sd_v / std::max(fall_v, min_fall_v) * span_percent, units::percent_per_whole);
}

BatteryState state_after(const Battery& battery, const DischargeRecord& flown, double initial_soc_percent) {
    BatteryState state{initial_soc_percent, 0.0};
    if (flown.time_s.empty()) return state;
    const double drawn_ah = flown.charge_ah.back();
    state.soc_percent -= units::percentage(drawn_ah, battery.capacity_ah);
    if (state.soc_percent < 0.0) {
        throw NoResultError(
            fmt::format("{:.3f} Ah were drawn from {:.1f} % of a battery of {:.3f} Ah: check the battery file",
                        drawn_ah, initial_soc_percent, battery.capacity_ah));
    }
    if (battery.thevenin && battery.thevenin->rc_resistance_ohm > 0.0) {
        state.rc_voltage_v = battery.thevenin->rc_resistance_ohm *
                             rc_branch_current_a(flown, battery.thevenin->rc_time_constant_s).back();
    }
    return state;
}

Discharge discharge_constant_load(const Battery& battery, const BatteryState& from, const ConstantLoad& load,
                                  double cutoff_voltage_v) {
    const Load constant{[power_w = load.power_w](double) { return power_w; }, 0.0, load.duration_s};
    if (battery.thevenin && load.power_w >= 0.0)
        return fast_discharge(battery, constant, from, {fast_step_s, cutoff_voltage_v});
    return discharge(battery, constant, from, {exact_step_s, cutoff_voltage_v});
}

LandingForecast forecast_landing(const Battery& battery, const BatteryState& now, std::span<const ConstantLoad> ahead,
                                 double cruise_w, const LandingLimits& limits) {
    LandingForecast forecast;
    forecast.soc_now_percent = now.soc_percent;
    BatteryState state = now;
    double flown_s = 0.0;
    double power_w = 0.0;
    for (const auto& load : ahead) {
        if (load.duration_s == 0.0) continue;
        const auto end = discharge_constant_load(battery, state, load, limits.cutoff_voltage_v);
        state = end;
        power_w = load.power_w;
        if (const auto failed_s = end.failed_at_s()) {
            forecast.fails_after_s = flown_s + *failed_s;
            break;
        }
        flown_s += load.duration_s;
    }
    forecast.soc_percent = state.soc_percent;
    forecast.voltage_v = terminal_voltage_v(battery, state, limited_current_a(battery, power_w, state));
    forecast.keeps_reserve = !forecast.fails_after_s && forecast.soc_percent >= limits.reserve_soc_percent;
    if (!forecast.fails_after_s) forecast.endurance_s = compute_endurance_s(battery, state, cruise_w, limits);
    return forecast;
}

}  // namespace flightwatt::battery
