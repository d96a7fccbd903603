#include "base/error.h"
#include "base/units.h"
#include "exchange/parameters/pack_facts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr auto energy_monitor = "Paparazzi's energy monitor";
constexpr std::array cell_currents_a{2.0, 4.0, 6.0, 8.0, 10.0};
constexpr int highest_cv = 420;  // hundredths of a volt
constexpr int lowest_cv = 250;
constexpr double cv_per_v = 100.0;

/// Power in level flight as the monitor's polynomial of the airspeed.
struct AirspeedPolynomial {
    Eigen::Vector3d coefficients;  ///< of V^2, V and 1
    double worst_w = 0.0;          ///< how far it is off the model at most, where the model was flown
};

AirspeedPolynomial airspeed_polynomial(const mechanical::PhysicalModel& physical, double compute_w) {
    constexpr int points = 101;
    const auto& [low, high] = physical.airspeed_m_per_s;
    Eigen::MatrixXd basis(points, 3);
    Eigen::VectorXd power_w(points);
    for (int i = 0; i < points; ++i) {
        const double airspeed = std::lerp(low, high, i / (points - 1.0));
        basis.row(i) << airspeed * airspeed, airspeed, 1.0;
        power_w[i] = mechanical::power_w(physical, {airspeed, 0.0, 1.0}) + compute_w;
    }
    AirspeedPolynomial polynomial;
    polynomial.coefficients = basis.colPivHouseholderQr().solve(power_w);
    polynomial.worst_w = (power_w - basis * polynomial.coefficients).cwiseAbs().maxCoeff();
    return polynomial;
}

double phase_energy_wh(const EstimatorInput& input, flight::Phase phase) {
    return units::wh_from_joule(mean_power_w(input, phase) * input.model->phases[phase].duration_s);
}

/// The charge drawn of a full pack, as a part, when its open-circuit voltage has fallen to `voltage_v`: 0 above the
/// full one, 1 below the empty one.
double drawn_fraction(const battery::OpenCircuitVoltage& curve, double voltage_v) {
    const auto& volts = curve.voltage_v;
    if (voltage_v >= volts.back()) return 0.0;
    if (voltage_v <= volts.front()) return 1.0;
    const auto above = std::ranges::upper_bound(volts, voltage_v);
    const auto upper = static_cast<std::size_t>(above - volts.begin());
    const double fraction = (voltage_v - volts[upper - 1]) / (volts[upper] - volts[upper - 1]);
    const double soc_percent = std::lerp(curve.soc_percent[upper - 1], curve.soc_percent[upper], fraction);
    return 1.0 - soc_percent / units::percent_per_whole;
}

}  // namespace

ParameterText to_paparazzi(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, energy_monitor);
    const auto& model = required_model(input, energy_monitor);
    if (!model.physical) {
        throw InputError(
            {}, fmt::format("the model {} knows no airspeed, over which {} takes power", model.name, energy_monitor),
            "fit one with flightwatt fit --model physical");
    }
    const auto power = airspeed_polynomial(*model.physical, input.compute_w);
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
                    power.coefficients[0], power.coefficients[1], power.coefficients[2], land_wh,
                    phase_energy_wh(input, flight::Phase::takeoff), land_wh / mean_v / units::milli,
                    mean_power_w(input, flight::Phase::cruise), model.phases[flight::Phase::landing].duration_s);
    const auto& [low, high] = model.physical->airspeed_m_per_s;
    result.notes.push_back(
        fmt::format("the polynomial is off the model by up to {:.2f} W from {:.1f} to {:.1f} m/s; "
                    "beyond, it is extrapolated",
                    power.worst_w, low, high));
    return result;
}

ParameterText to_paparazzi_map(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, energy_monitor);
    if (!pack.battery.thevenin) {
        throw InputError({}, "the battery has one voltage at all states of charge: there is no charge to tell by it",
                         "identify the open-circuit voltage with flightwatt battery");
    }
    const double cell_mah = pack.capacity_mah / input.cells_in_parallel;
    ParameterText result;
    for (int cv = highest_cv; cv >= lowest_cv; --cv) {
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
