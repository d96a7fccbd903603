#include "base/error.h"
#include "exchange/parameters/pack_facts.h"

#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr auto px4 = "PX4";
constexpr int max_px4_cells = 16;
constexpr double max_resistance_ohm = 0.2;  // of a cell
constexpr double max_capacity_mah = 100'000.0;
constexpr double max_current_a = 500.0;
constexpr double half_charged_percent = 50.0;

/// PX4's state of charge by voltage is linear from V_EMPTY to V_CHARGED.
struct VoltageLine {
    double empty_v = 0.0;  ///< of a cell, at rest
    double charged_v = 0.0;
    double worst_percent = 0.0;  ///< how far the state of charge by it is off at most, where the line was fitted
};

/// The line of least squares through the open-circuit voltage of a cell from 10 to 100 % of charge: PX4 asks for a
/// voltage before the steep drop.
VoltageLine voltage_line(const PackSummary& pack) {
    constexpr int points = 91;
    Eigen::MatrixXd basis(points, 2);
    Eigen::VectorXd volts(points);
    for (int i = 0; i < points; ++i) {
        const double soc_percent = 10.0 + i;
        basis.row(i) << 1.0, soc_percent / 100.0;
        volts[i] = open_circuit_voltage_v(pack.battery, soc_percent) / pack.cells;
    }
    const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(volts);
    VoltageLine result{line[0], line[0] + line[1]};
    result.worst_percent = ((volts - basis * line) / line[1] * 100.0).cwiseAbs().maxCoeff();
    return result;
}

void require_up_to(double value, double most, const char* name, const char* unit) {
    if (value <= most) return;
    throw InputError({}, fmt::format("{} would be {:.4g} {}: PX4 takes up to {:g}", name, value, unit, most),
                     "is the number of cells right (--cells)?");
}

/// MAV_PARAM_TYPE of MAVLink.
enum class ParameterType { int32 = 6, real32 = 9 };

std::string px4_line(const char* name, double value, ParameterType type) {
    const auto text = type == ParameterType::int32 ? fmt::format("{:.0f}", value) : fmt::format("{:.9g}", value);
    return fmt::format("1\t1\t{}\t{}\t{}\n", name, text, static_cast<int>(type));
}

}  // namespace

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
        const auto voltages = voltage_line(pack);
        if (!(voltages.charged_v > voltages.empty_v)) {
            throw InputError({}, "has one voltage at all states of charge, by which PX4 cannot tell the charge",
                             "identify the open-circuit voltage with flightwatt battery");
        }
        result.text += px4_line("BAT1_V_EMPTY", voltages.empty_v, ParameterType::real32);
        result.text += px4_line("BAT1_V_CHARGED", voltages.charged_v, ParameterType::real32);
        result.notes.push_back(
            fmt::format("PX4's state of charge by voltage is a straight line: from 10 to 100 % it is "
                        "off by up to {:.0f} points",
                        voltages.worst_percent));
    } else {
        result.notes.emplace_back("the battery has a constant voltage: BAT1_V_EMPTY and BAT1_V_CHARGED are left out");
    }
    if (input.model) {
        const double current_a =
            internal_current_a(pack.battery, mean_power_w(input, flight::Phase::cruise), {half_charged_percent, 0.0});
        require_up_to(current_a, max_current_a, "BAT_AVRG_CURRENT", "A");
        result.text += px4_line("BAT_AVRG_CURRENT", current_a, ParameterType::real32);
    } else {
        result.notes.emplace_back("without a model BAT_AVRG_CURRENT is left out");
    }
    return result;
}

}  // namespace flightwatt::exchange
