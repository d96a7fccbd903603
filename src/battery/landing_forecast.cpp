#include "battery/landing_forecast.h"

#include "base/error.h"
#include "base/units.h"
#include "battery/fast_discharge.h"

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

/// A day: whoever flies longer charges meanwhile.
constexpr double max_s = 86400.0;
constexpr double step_s = 5.0;  // of Runge-Kutta under constant power: a charge and a voltage that hardly bend
constexpr double quick_step_s = 20.0;

/// When a battery stopped; the end of the stretch if it did not.
std::optional<double> failed_at_s(const Discharge& discharge) {
    if (const auto ended = discharge.ended_at_s()) return ended;
    if (discharge.undeliverable) return discharge.undeliverable->time_s;
    return std::nullopt;
}

/// How long a power can be drawn until the battery fails or has only its reserve.
double compute_endurance_s(const Battery& battery, BatteryState state, double power_w, const LandingLimits& limits) {
    constexpr double stretch_s = 60.0;
    constexpr int bisections = 30;
    const auto after = [&](double time_s) {
        return discharge_constant_load(battery, state, {power_w, time_s}, limits.cutoff_voltage_v);
    };
    if (!(power_w > 0.0) || state.soc_percent <= limits.reserve_soc_percent) return 0.0;
    double low_s = 0.0;
    double begun_s = 0.0;
    while (begun_s < max_s) {
        const auto end = after(stretch_s);
        const auto failed_s = failed_at_s(end);
        if (end.soc_percent >= limits.reserve_soc_percent) {
            if (failed_s) return begun_s + *failed_s;
            state = end;
            begun_s += stretch_s;
            continue;
        }
        double high_s = failed_s.value_or(stretch_s);
        for (int i = 0; i < bisections; ++i) {
            const double middle_s = 0.5 * (low_s + high_s);
            (after(middle_s).soc_percent >= limits.reserve_soc_percent ? low_s : high_s) = middle_s;
        }
        return begun_s + low_s;
    }
    return max_s;
}

}  // namespace

double resting_soc_percent(const Battery& battery, double voltage_v) {
    constexpr int bisections = 50;
    double low = 0.0;
    double high = units::percent_per_whole;
    for (int i = 0; i < bisections; ++i) {
        const double middle = 0.5 * (low + high);
        (open_circuit_voltage_v(battery, middle) < voltage_v ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

BatteryState state_after(const Battery& battery, const DischargeRecord& flown, double initial_soc_percent) {
    BatteryState state{initial_soc_percent, 0.0};
    if (flown.time_s.empty()) return state;
    const double drawn_ah = flown.charge_ah.back();
    state.soc_percent -= units::percentage(drawn_ah, battery.capacity_ah);
    if (state.soc_percent < 0.0) {
        throw NoResultError(
            fmt::format("{:.3f} Ah were drawn from {:.1f} % of a battery of {:.3f} Ah: is it another one?", drawn_ah,
                        initial_soc_percent, battery.capacity_ah));
    }
    if (battery.thevenin && battery.thevenin->rc_resistance_ohm > 0.0) {
        state.rc_voltage_v = battery.thevenin->rc_resistance_ohm *
                             rc_branch_current_a(flown, battery.thevenin->rc_time_constant_s).back();
    }
    return state;
}

Discharge discharge_constant_load(const Battery& battery, const BatteryState& from, const ConstantLoad& stretch,
                                  double cutoff_voltage_v) {
    const double power_w = stretch.power_w;
    const Load load{[power_w](double) { return power_w; }, 0.0, stretch.duration_s};
    if (battery.thevenin && power_w >= 0.0)
        return fast_discharge(battery, load, from, {quick_step_s, cutoff_voltage_v});
    return discharge(battery, load, from, {step_s, cutoff_voltage_v});
}

LandingForecast forecast_landing(const Battery& battery, const BatteryState& now, std::span<const ConstantLoad> ahead,
                                 double cruise_w, const LandingLimits& limits) {
    LandingForecast forecast;
    forecast.soc_now_percent = now.soc_percent;
    BatteryState state = now;
    double flown_s = 0.0;
    double power_w = 0.0;
    for (const auto& stretch : ahead) {
        if (stretch.duration_s == 0.0) continue;
        const auto end = discharge_constant_load(battery, state, stretch, limits.cutoff_voltage_v);
        state = end;
        power_w = stretch.power_w;
        if (const auto failed_s = failed_at_s(end)) {
            forecast.fails_after_s = flown_s + *failed_s;
            break;
        }
        flown_s += stretch.duration_s;
    }
    forecast.soc_percent = state.soc_percent;
    forecast.voltage_v = terminal_voltage_v(battery, state, limited_current_a(battery, power_w, state));
    forecast.keeps_reserve = !forecast.fails_after_s && forecast.soc_percent >= limits.reserve_soc_percent;
    if (!forecast.fails_after_s) forecast.endurance_s = compute_endurance_s(battery, state, cruise_w, limits);
    return forecast;
}

}  // namespace flightwatt::battery
