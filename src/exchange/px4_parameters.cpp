#include "exchange/px4_parameters.h"

#include "base/error.h"
#include "base/units.h"
#include "battery/landing_forecast.h"
#include "exchange/estimators/pack_summary.h"
#include "exchange/estimators/px4_lines.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr auto px4 = "PX4";
constexpr auto px4_sitl = "PX4's SITL";
constexpr int max_px4_cells = 16;
constexpr double max_resistance_ohm = 0.2;  // of a cell
constexpr double max_capacity_mah = 100'000.0;
constexpr double max_current_a = 500.0;
constexpr double max_drain_s = 86'400.0;

void require_up_to(double value, double max, const char* name, const char* unit) {
    if (value <= max) return;
    throw InputError({}, fmt::format("{} would be {:.4g} {}: PX4 takes up to {:g}", name, value, unit, max),
                     "are battery, model and number of cells (--cells) those of one aircraft?");
}

std::string cells_line(const PackSummary& pack, int monitor = 1) {
    require_up_to(pack.cells, max_px4_cells, "BAT1_N_CELLS", "cells");
    return px4_line(fmt::format("BAT{}_N_CELLS", monitor), pack.cells, ParameterType::int32);
}

/// Of a cell.
std::string voltage_lines(const PackSummary& pack, const VoltageLine& line, int monitor = 1) {
    if (!(line.full_v - line.empty_v > units::milli)) {
        throw InputError({}, "the voltage of this battery does not depend on its state of charge, as PX4 requires",
                         "identify the open-circuit voltage with flightwatt battery");
    }
    return px4_line(fmt::format("BAT{}_V_EMPTY", monitor), line.empty_v / pack.cells) +
           px4_line(fmt::format("BAT{}_V_CHARGED", monitor), line.full_v / pack.cells);
}

/// Of one monitor: its pack's part of the charge, and the resistance over which its part of the current falls.
std::string pack_lines(const PackSummary& pack, const flight::MonitorShare& monitor) {
    auto text = cells_line(pack, monitor.number);
    if (monitor.part == 0.0) return text;
    const double cell_ohm = pack.battery.resistance_ohm / pack.cells / monitor.part;
    require_up_to(cell_ohm, max_resistance_ohm, "BAT1_R_INTERNAL", "ohm");
    require_up_to(pack.capacity_mah, max_capacity_mah, "BAT1_CAPACITY", "mAh");
    return text + px4_line(fmt::format("BAT{}_CAPACITY", monitor.number), pack.capacity_mah * monitor.part) +
           px4_line(fmt::format("BAT{}_R_INTERNAL", monitor.number), cell_ohm);
}

/// Until the full battery is empty; where it fails before, at the rate until then.
double drain_s(const battery::Battery& battery, double power_w) {
    const auto end = discharge_constant_load(battery, {}, {power_w, max_drain_s}, 0.0);
    const double lasts_s = end.failed_at_s().value_or(max_drain_s);
    if (lasts_s < 1.0)
        throw NoResultError(fmt::format("the full battery cannot deliver the {:.4g} W of the cruise", power_w));
    return lasts_s * units::percent_per_whole / (units::percent_per_whole - end.soc_percent);
}

}  // namespace

ParameterText to_px4(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, px4);
    ParameterText result{px4_head(px4)};
    const auto monitors = noted_monitors(input, result);
    for (const auto& monitor : monitors) result.text += pack_lines(pack, monitor);
    if (pack.battery.thevenin) {
        const auto line = fit_voltage_line(pack.battery, PackSummary{}.lowest_percent);
        for (const auto& monitor : monitors) result.text += voltage_lines(pack, line, monitor.number);
        result.notes.push_back(
            fmt::format("PX4's state of charge by voltage is a line: from 10 to 100 % its error is up to {:.0f} points",
                        units::percentage(line.error_v, line.full_v - line.empty_v)));
    } else {
        result.notes.emplace_back("the battery has a constant voltage: BAT1_V_EMPTY and BAT1_V_CHARGED are omitted");
    }
    const double part = std::ranges::max(monitors, {}, &flight::MonitorShare::part).part;
    if (input.model && part > 0.0) {
        const double current_a = part * cruise_current_a(input, pack);
        require_up_to(current_a, max_current_a, "BAT_AVRG_CURRENT", "A");
        result.text += px4_line("BAT_AVRG_CURRENT", current_a);
    } else if (!input.model) {
        result.notes.emplace_back("without a model BAT_AVRG_CURRENT is omitted");
    }
    return result;
}

ParameterText to_px4_sitl(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, px4_sitl);
    required_model(input, px4_sitl);
    const double cruise_w = mean_power_w(input, flight::Phase::cruise);
    const double full_s = drain_s(*input.battery, cruise_w);
    require_up_to(full_s, max_drain_s, "SIM_BAT_DRAIN", "s");
    const auto line = fit_voltage_line(pack.battery, pack.lowest_percent);
    const double drop_v = pack.battery.resistance_ohm * cruise_current_a(input, pack);
    ParameterText result{px4_head(px4_sitl)};
    result.text +=
        note_limits({voltage_limit(line), fmt::format("the voltage drop under load, in cruise {:.2f} V", drop_v),
                     "charge by current: it falls evenly in time while armed, on the ground too", power_limit(input)},
                    "# ", result) +
        px4_line("SIM_BAT_ENABLE", 1, ParameterType::int32) + px4_line("SIM_BAT_DRAIN", full_s) +
        px4_line("SIM_BAT_MIN_PCT", 0.0) + cells_line(pack) + voltage_lines(pack, line);
    return result;
}

}  // namespace flightwatt::exchange
