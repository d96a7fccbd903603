#include "battery/battery.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::battery {
namespace {

double limit_at_w(const Battery& battery, double voltage_v) {
    if (voltage_v <= 0.0) return 0.0;
    if (battery.resistance_ohm == 0.0) return std::numeric_limits<double>::infinity();
    return voltage_v * voltage_v / (4.0 * battery.resistance_ohm);
}

/// The current at a voltage before the resistor, of a power that is not beyond the limit.
double current_at_a(const Battery& battery, double voltage_v, double power_w) {
    if (power_w == 0.0) return 0.0;
    const double u = std::max(0.0, voltage_v);
    // (U - sqrt(D)) / (2 R), multiplied out: no difference of near numbers, no division by R. At the limit
    // rounding may leave D a hair below zero.
    const double discriminant = std::max(0.0, u * u - 4.0 * battery.resistance_ohm * power_w);
    return 2.0 * power_w / (u + std::sqrt(discriminant));
}

/// [V] before the series resistor: open circuit less the RC pair.
double source_voltage_v(const Battery& battery, const BatteryState& state) {
    return open_circuit_voltage_v(battery, state.soc_percent) - state.rc_voltage_v;
}

}  // namespace

std::vector<flight::MonitorShare> common_monitors(const std::vector<std::vector<flight::MonitorShare>>& flights) {
    constexpr double same_part = 0.05;
    constexpr double written_parts = 1000.0;
    std::map<int, std::vector<double>> parts;
    for (const auto& monitors : flights) {
        if (monitors.empty()) parts[1].push_back(1.0);
        for (const auto& [number, part] : monitors) parts[number].push_back(part);
    }
    if (parts.empty() || (parts.size() == 1 && parts.begin()->first == 1)) return {};
    std::vector<flight::MonitorShare> common;
    bool are_known = true;
    for (const auto& [number, values] : parts) {
        const auto [low, high] = std::ranges::minmax(values);
        are_known = are_known && values.size() == flights.size() && low > 0.0 && high - low <= same_part;
        common.push_back({number, std::round(mean(values) * written_parts) / written_parts});
    }
    if (!are_known)
        for (auto& monitor : common) monitor.part = 0.0;
    return common;
}

std::string describe_monitors(const Battery& battery) {
    const auto& monitors = battery.monitors;
    if (monitors.empty()) return "";
    if (monitors.size() == 1) return fmt::format("pack: on battery monitor {}", monitors.front().number);
    std::vector<std::string> parts;
    parts.reserve(monitors.size());
    const bool are_known = monitors.front().part > 0.0;
    for (const auto& [number, part] : monitors) {
        parts.push_back(fmt::format("battery monitor {}", number));
        if (are_known) parts.back() += fmt::format(" counts {:.1f} %", part * units::percent_per_whole);
    }
    return fmt::format("packs: the charge is that of all together, of which {}{}", fmt::join(parts, " and "),
                       are_known ? "" : " count parts that are not known, as the flights differ");
}

double full_energy_wh(const Battery& battery) {
    if (!battery.thevenin) return battery.capacity_ah * battery.voltage_v;
    const auto& [knots, voltage_v] = battery.thevenin->open_circuit;
    double integral = 0.0;  // [V points]
    for (std::size_t k = 1; k < knots.size(); ++k)
        integral += (knots[k] - knots[k - 1]) * (voltage_v[k - 1] + voltage_v[k]) / 2.0;
    return battery.capacity_ah * integral / (knots.back() - knots.front());
}

double open_circuit_voltage_v(const Battery& battery, double soc_percent) {
    if (!battery.thevenin) return battery.voltage_v;
    const auto& curve = battery.thevenin->open_circuit;
    return interpolate_clamped(curve.soc_percent, curve.voltage_v, soc_percent);
}

double warmed_resistance_ohm(const Battery& battery, double warming_per_j, double heat_a2s) {
    return battery.resistance_ohm / (1.0 + warming_per_j * battery.resistance_ohm * heat_a2s);
}

Battery settled(Battery battery) {
    if (!battery.thevenin) return battery;
    battery.resistance_ohm += battery.thevenin->rc_resistance_ohm;
    battery.thevenin->rc_resistance_ohm = 0.0;
    return battery;
}

double terminal_voltage_v(const Battery& battery, const BatteryState& state, double current_a) {
    return source_voltage_v(battery, state) - battery.resistance_ohm * current_a;
}

double power_limit_w(const Battery& battery, const BatteryState& state) {
    return limit_at_w(battery, source_voltage_v(battery, state));
}

double internal_current_a(const Battery& battery, double power_w, const BatteryState& state) {
    const double limit_w = power_limit_w(battery, state);
    if (power_w > limit_w) {
        throw NoResultError(
            fmt::format("the battery cannot deliver {} W: its limit U^2 / (4 R) is {} W", power_w, limit_w));
    }
    return current_at_a(battery, source_voltage_v(battery, state), power_w);
}

double limited_current_a(const Battery& battery, double power_w, const BatteryState& state) {
    const double voltage_v = source_voltage_v(battery, state);
    return current_at_a(battery, voltage_v, std::min(power_w, limit_at_w(battery, voltage_v)));
}

std::optional<Battery> estimated_by_flights(const Battery& battery) {
    if (!battery.flight_estimate) return std::nullopt;
    const auto& [capacity_ah, interval_ah, flights, open_circuit] = *battery.flight_estimate;
    if (interval_ah.low <= battery.capacity_ah && battery.capacity_ah <= interval_ah.high) return std::nullopt;
    auto estimated = battery;
    estimated.capacity_ah = capacity_ah;
    estimated.intervals.capacity_ah = interval_ah;
    if (!open_circuit.soc_percent.empty()) {
        estimated.thevenin.value().open_circuit = open_circuit;
        estimated.intervals.open_circuit_standard_error_v.clear();  // those are of the other curve's knots
    }
    return estimated;
}

std::string capacity_warning(const Battery& battery) {
    if (!estimated_by_flights(battery)) return "";
    const auto& [low, high] = battery.flight_estimate->capacity_interval_ah;
    return fmt::format(
        "the capacity of {:.4g} Ah contradicts the flights, which indicate {:.3g} Ah ({:.3g} to {:.3g} Ah in 95 %): "
        "check the pack's label, the scale of the current sensor, and whether the flights are of one pack; without a "
        "capacity the estimate of the flights is used",
        battery.capacity_ah, battery.flight_estimate->capacity_ah, low, high);
}

std::vector<std::string> battery_warnings(const Battery& battery) {
    constexpr double min_v = 2.5;
    constexpr double max_v = 60.0;
    constexpr double min_ah = 0.05;
    constexpr double min_limit_w = 1.0;
    std::vector<std::string> warnings;
    const auto full_v = open_circuit_voltage_v(battery, units::percent_per_whole);
    if (full_v < min_v || full_v > max_v) {
        warnings.push_back(fmt::format("battery: {:.4g} V when full is {}: check that the unit is V", full_v,
                                       full_v < min_v ? "less than one cell's" : "more than 14 LiPo cells'"));
    }
    if (battery.capacity_ah < min_ah) {
        warnings.push_back(fmt::format("battery: {:.4g} Ah is too small for a drone's pack: check that the unit is Ah",
                                       battery.capacity_ah));
    }
    if (const auto warning = capacity_warning(battery); !warning.empty()) warnings.push_back("battery: " + warning);
    if (const double limit_w = power_limit_w(battery); limit_w < min_limit_w) {
        warnings.push_back(
            fmt::format("battery: it cannot deliver more than {:.3g} W: check that resistance_ohm is in ohm", limit_w));
    }
    return warnings;
}

}  // namespace flightwatt::battery
