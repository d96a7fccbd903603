#include "exchange/autopilot_parameters.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr double max_charged_cell_v = 4.25;

/// The battery for estimators with a single resistance: in the steady state of the RC pair.
struct PackSummary {
    battery::Battery battery;  ///< with the RC pair's resistance in series
    int cells = 1;             ///< in series
    double capacity_mah = 0.0;
    double energy_wh = 0.0;  ///< at the open-circuit voltage, from full to empty
};

/// Throws InputError without a battery.
PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader) {
    if (!input.battery) {
        throw InputError({}, fmt::format("{} needs a battery, and none is given", reader),
                         "give a pack of `flightwatt battery`, or a mission");
    }
    PackSummary pack;
    pack.battery = *input.battery;
    if (pack.battery.thevenin) {
        pack.battery.resistance_ohm += pack.battery.thevenin->rc_resistance_ohm;
        pack.battery.thevenin->rc_resistance_ohm = 0.0;
    }
    const double full_v = open_circuit_voltage_v(pack.battery, units::percent_per_whole);
    const auto min_cells = static_cast<int>(std::max(1.0, std::ceil(full_v / max_charged_cell_v)));
    pack.cells = input.cells_in_series.value_or(pack.battery.cells.value_or(min_cells));
    pack.capacity_mah = pack.battery.capacity_ah / units::milli;
    pack.energy_wh = full_energy_wh(pack.battery);
    return pack;
}

/// Throws InputError without a model.
const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader) {
    if (!input.model) {
        throw InputError({}, fmt::format("{} needs a mechanical model, and none is given", reader),
                         "give a model of `flightwatt fit` or `batch` with the battery, or a mission");
    }
    return *input.model;
}

/// The model's mean power of a phase, and the computer's [W].
double mean_power_w(const EstimatorInput& input, flight::Phase phase) {
    const auto& curve = input.model.value().phases[phase];
    return energy_j(curve.fourier, curve.duration_s) / curve.duration_s + input.compute_w;
}

/// A least-squares polynomial of a curve.
struct CurveFit {
    Eigen::VectorXd coefficients;  ///< of 1, x, x^2 ...
    double max_error = 0.0;
};

template <typename Curve>
CurveFit fitted_polynomial(const mechanical::FlownRange& range, int points, int order, const Curve& curve) {
    Eigen::MatrixXd powers(points, order + 1);
    Eigen::VectorXd values(points);
    for (int i = 0; i < points; ++i) {
        const double x = std::lerp(range.low, range.high, i / (points - 1.0));
        for (int k = 0; k <= order; ++k) powers(i, k) = std::pow(x, k);
        values[i] = curve(x);
    }
    CurveFit fit{powers.colPivHouseholderQr().solve(values)};
    fit.max_error = (values - powers * fit.coefficients).cwiseAbs().maxCoeff();
    return fit;
}

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

constexpr auto px4 = "PX4";
constexpr int max_px4_cells = 16;
constexpr double max_resistance_ohm = 0.2;  // of a cell
constexpr double max_capacity_mah = 100'000.0;
constexpr double max_current_a = 500.0;
constexpr double half_charged_percent = 50.0;

void require_up_to(double value, double max, const char* name, const char* unit) {
    if (value <= max) return;
    throw InputError({}, fmt::format("{} would be {:.4g} {}: PX4 takes up to {:g}", name, value, unit, max),
                     "is the number of cells right (--cells)?");
}

/// MAV_PARAM_TYPE of MAVLink.
enum class ParameterType { int32 = 6, real32 = 9 };

std::string px4_line(const char* name, double value, ParameterType type) {
    const auto text = type == ParameterType::int32 ? fmt::format("{:.0f}", value) : fmt::format("{:.9g}", value);
    return fmt::format("1\t1\t{}\t{}\t{}\n", name, text, static_cast<int>(type));
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
    const auto power = fitted_polynomial(model.physical->airspeed_m_per_s, airspeeds, 2, [&](double airspeed) {
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

ParameterText to_px4(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, px4);
    const double cell_ohm = pack.battery.resistance_ohm / pack.cells;
    require_up_to(pack.cells, max_px4_cells, "BAT1_N_CELLS", "cells");
    require_up_to(cell_ohm, max_resistance_ohm, "BAT1_R_INTERNAL", "ohm");
    require_up_to(pack.capacity_mah, max_capacity_mah, "BAT1_CAPACITY", "mAh");
    ParameterText result;
    result.text = "# Written by flightwatt export " FLIGHTWATT_VERSION
                  ", for PX4 and QGroundControl\n"
                  "# Vehicle-Id Component-Id Name Value Type\n";
    result.text += px4_line("BAT1_N_CELLS", pack.cells, ParameterType::int32);
    result.text += px4_line("BAT1_CAPACITY", pack.capacity_mah, ParameterType::real32);
    result.text += px4_line("BAT1_R_INTERNAL", cell_ohm, ParameterType::real32);
    if (pack.battery.thevenin) {
        // A cell's resting voltage as a line from 10 % on: PX4 requires voltages above the steep drop.
        constexpr int charges = 91;
        const auto line = fitted_polynomial({10.0, units::percent_per_whole}, charges, 1, [&](double soc_percent) {
            return open_circuit_voltage_v(pack.battery, soc_percent) / pack.cells;
        });
        const double empty_v = line.coefficients[0];
        const double v_per_percent = line.coefficients[1];
        if (!(v_per_percent > 0.0)) {
            throw InputError({}, "the voltage of this battery does not depend on its state of charge, as PX4 requires",
                             "identify the open-circuit voltage with flightwatt battery");
        }
        result.text += px4_line("BAT1_V_EMPTY", empty_v, ParameterType::real32);
        result.text +=
            px4_line("BAT1_V_CHARGED", empty_v + v_per_percent * units::percent_per_whole, ParameterType::real32);
        result.notes.push_back(
            fmt::format("PX4's state of charge by voltage is a line: from 10 to 100 % its error is up to "
                        "{:.0f} points",
                        line.max_error / v_per_percent));
    } else {
        result.notes.emplace_back("the battery has a constant voltage: BAT1_V_EMPTY and BAT1_V_CHARGED are omitted");
    }
    if (input.model) {
        const double current_a =
            internal_current_a(pack.battery, mean_power_w(input, flight::Phase::cruise), {half_charged_percent, 0.0});
        require_up_to(current_a, max_current_a, "BAT_AVRG_CURRENT", "A");
        result.text += px4_line("BAT_AVRG_CURRENT", current_a, ParameterType::real32);
    } else {
        result.notes.emplace_back("without a model BAT_AVRG_CURRENT is omitted");
    }
    return result;
}

}  // namespace flightwatt::exchange
