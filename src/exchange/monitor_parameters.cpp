#include "exchange/monitor_parameters.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"
#include "exchange/estimators/pack_summary.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr auto inav = "INAV";
constexpr int max_inav_cells = 12;
constexpr double cw_per_w = 100.0;     // INAV's powers are in 0.01 W,
constexpr double mwh_per_wh = 1000.0;  // its energies in mWh,
constexpr double cm_per_m = 100.0;     // its speeds in cm/s

/// Rounded. Throws InputError beyond the range of INAV's setting.
template <typename Stored>
long long whole(double value, const char* name) {
    const double rounded = std::round(value);
    if (rounded >= 0.0 && rounded <= static_cast<double>(std::numeric_limits<Stored>::max()))
        return static_cast<long long>(rounded);
    throw InputError({}, fmt::format("{} would be {:.6g}: INAV takes 0 to {}", name, rounded,
                                     static_cast<long long>(std::numeric_limits<Stored>::max())));
}

constexpr auto energy_monitor = "Paparazzi's energy monitor";
constexpr std::array cell_currents_a{2.0, 4.0, 6.0, 8.0, 10.0};
constexpr int max_cv = 420;  // hundredths of a volt
constexpr int min_cv = 250;
constexpr double cv_per_v = 100.0;

double phase_energy_wh(const EstimatorInput& input, flight::Phase phase) {
    return units::wh_from_joule(mean_power_w(input, phase) * input.model->phases[phase].duration_s);
}

/// The fraction of a full pack that is drawn at an open-circuit voltage, 0 to 1.
double drawn_fraction(const battery::OpenCircuitVoltage& curve, double voltage_v) {
    if (voltage_v >= curve.voltage_v.back()) return 0.0;
    return 1.0 - interpolate_clamped(curve.voltage_v, curve.soc_percent, voltage_v) / units::percent_per_whole;
}

}  // namespace

ParameterText to_inav(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, inav);
    const auto& model = required_model(input, inav);
    if (pack.cells > max_inav_cells) {
        throw InputError({}, fmt::format("bat_cells would be {}: INAV takes up to {}", pack.cells, max_inav_cells),
                         "is the number of cells right (--cells)?");
    }
    const double cruise_w = mean_power_w(input, flight::Phase::cruise);
    const double idle_w = input.idle_w.value_or(input.compute_w);
    if (idle_w >= cruise_w) {
        throw InputError({}, fmt::format("idles at {:.1f} W, and cruises at {:.1f} W", idle_w, cruise_w),
                         "expected the power with the motor off (--idle-power)");
    }
    ParameterText result;
    const auto set = [&](const char* name, auto value) { result.text += fmt::format("set {} = {}\n", name, value); };
    result.text = "# Written by flightwatt export " FLIGHTWATT_VERSION ", for INAV's CLI; then: save\n";
    set("bat_cells", pack.cells);
    set("battery_capacity_unit", "MWH");
    set("battery_capacity", whole<std::uint32_t>(pack.energy_wh * mwh_per_wh, "battery_capacity"));
    set("idle_power", whole<std::uint16_t>(idle_w * cw_per_w, "idle_power"));
    set("cruise_power", whole<std::uint32_t>((cruise_w - idle_w) * cw_per_w, "cruise_power"));
    if (model.physical) {
        set("nav_fw_cruise_speed",
            whole<std::uint16_t>(model.physical->mean_airspeed_m_per_s * cm_per_m, "nav_fw_cruise_speed"));
    } else {
        result.notes.emplace_back(
            "the model has no airspeed: nav_fw_cruise_speed is omitted (fit --model-kind physical)");
    }
    if (input.reserve_percent) {
        set("rth_energy_margin", whole<std::uint8_t>(*input.reserve_percent, "rth_energy_margin"));
    } else {
        result.notes.emplace_back("no mission states a reserve: rth_energy_margin is omitted");
    }
    return result;
}

ParameterText to_paparazzi(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, energy_monitor);
    const auto& model = required_model(input, energy_monitor);
    if (!model.physical) {
        throw InputError({}, fmt::format("the model {} has no airspeed, which {} requires", model.name, energy_monitor),
                         "fit one with flightwatt fit --model-kind physical");
    }
    constexpr int airspeeds = 101;
    const auto power = fit_polynomial(model.physical->airspeed_m_per_s, airspeeds, 2, [&](double airspeed) {
        return mechanical::power_w(*model.physical, {airspeed, 0.0, 1.0}) + input.compute_w;
    });
    const double land_wh = phase_energy_wh(input, flight::Phase::landing);
    const double mean_v = pack.energy_wh / pack.battery.capacity_ah;
    ParameterText result;
    result.text =
        fmt::format("# Written by flightwatt export " FLIGHTWATT_VERSION
                    ", for sw/ground_segment/python/energy_mon\n"
                    "# battery_model.py\n"
                    "capacity = {:.0f}  # mAh, of a cell\ncells_in_series = {}\ncells_in_parallel = {}\n"
                    "cells_in_battery = cells_in_parallel * cells_in_series\n"
                    "# energy_mon_viewer.py, class EnergyPrediction\n"
                    "coeffs_power_from_airspeed = [{:.9g}, {:.9g}, {:.9g}]  # W of V^2, V and 1, V in m/s\n"
                    "energy_land = {:.4g}  # Wh\nenergy_takeoff = {:.4g}  # Wh\ncharge_land = {:.4g}  # mAh\n"
                    "power_hover = {:.4g}  # W, assumed up to 15 m/s: the cruise's\n"
                    "expected_landing_time = {:.0f}  # s\n",
                    pack.capacity_mah / input.cells_in_parallel, pack.cells, input.cells_in_parallel,
                    power.coefficients[2], power.coefficients[1], power.coefficients[0], land_wh,
                    phase_energy_wh(input, flight::Phase::takeoff), land_wh / mean_v / units::milli,
                    mean_power_w(input, flight::Phase::cruise), model.phases[flight::Phase::landing].duration_s);
    const auto& [low, high] = model.physical->airspeed_m_per_s;
    result.notes.push_back(
        fmt::format("the polynomial differs from the model by up to {:.2f} W from {:.1f} to {:.1f} m/s; "
                    "outside, it is extrapolated",
                    power.max_error, low, high));
    return result;
}

ParameterText to_paparazzi_map(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, energy_monitor);
    if (!pack.battery.thevenin) {
        throw InputError({}, "the voltage of this battery does not depend on its state of charge",
                         "identify the open-circuit voltage with flightwatt battery");
    }
    const double cell_mah = pack.capacity_mah / input.cells_in_parallel;
    ParameterText result;
    for (int cv = max_cv; cv >= min_cv; --cv) {
        result.text += fmt::format("{:.2f}", cv / cv_per_v);
        for (const double cell_a : cell_currents_a) {
            const double source_v =
                pack.cells * cv / cv_per_v + cell_a * input.cells_in_parallel * pack.battery.resistance_ohm;
            result.text +=
                fmt::format(", {:.6f}", cell_mah * drawn_fraction(pack.battery.thevenin->open_circuit, source_v));
        }
        result.text += '\n';
    }
    return result;
}

}  // namespace flightwatt::exchange
