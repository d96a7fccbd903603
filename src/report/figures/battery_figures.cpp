#include "base/statistics.h"
#include "base/text.h"
#include "base/units.h"
#include "battery/identification.h"
#include "report/figures/flight_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::size_t battery_columns = 130;  // of a panel

/// A curve as a screen shows it, broken where the record is not used.
void add_curve(FigureData& data, const battery::DischargeRecord& record, const std::vector<double>& voltage_v,
               std::string_view name) {
    for (const auto i : downsample_m4(record.time_s, voltage_v, battery_columns)) {
        data.add({record.time_s[i], record.used[i] ? voltage_v[i] : std::nan("")}, {name});
    }
}

FigureData voltage_rows(const battery::Battery& battery, const battery::DischargeRecord& record,
                        double initial_charge_ah) {
    FigureData data({"time_s", "voltage_v"}, {"curve"});
    add_curve(data, record, record.voltage_v, "measured");
    add_curve(data, record, predict_voltage(battery, record, initial_charge_ah).voltage_v, "model");
    return data;
}

/// The knots with their 95 % intervals, where those are known.
FigureData knot_rows(const battery::BatteryIdentification& identified) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    const auto& errors_v = identified.battery.intervals.open_circuit_standard_error_v;
    FigureData data({"soc_percent", "voltage_v", "low_v", "high_v"}, {"origin"});
    for (std::size_t i = 0; i < curve.soc_percent.size(); ++i) {
        const double reach_v = errors_v.empty() ? std::nan("") : normal_half_width() * errors_v[i];
        // Knots are rounded to their state of charge: the last one that was flown belongs to the flights.
        const bool flown = curve.soc_percent[i] >= identified.observed_min_soc_percent - 1e-6;
        data.add({curve.soc_percent[i], curve.voltage_v[i], curve.voltage_v[i] - reach_v, curve.voltage_v[i] + reach_v},
                 {flown ? "from flights" : "after the LiPo chart"});
    }
    return data;
}

}  // namespace

Figure voltage_figure(const battery::BatteryIdentification& identified,
                      std::span<const battery::DischargeRecord> records, const std::string& id) {
    auto description = fmt::format("Terminal voltage of {} flights over time, measured and modelled.", records.size());
    auto panels = VegaJson::array();
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& record = records[i];
        const auto [low, high] = std::ranges::minmax_element(record.voltage_v);
        description += fmt::format(" {}: {:.2f} to {:.2f} V.", record.flight, *low, *high);
        const auto rows = voltage_rows(identified.battery, record, identified.flights[i].initial_depletion_ah);
        panels.push_back({{"curves", rows.json()}, {"flight", valid_utf8(record.flight)}});
    }
    return new_figure(
        "voltage", id,
        "The model's voltage follows from the measured current and the charge that was missing at the start. "
        "Both are broken where the record contradicts itself: a current that the motor did not draw.",
        description, {{"panels", panels}});
}

Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    std::string caption = "Open-circuit voltage with the 95 % intervals of its knots.";
    if (identified.observed_min_soc_percent > 0.0) {
        caption += fmt::format(
            " Below {:.0f} % no flight shows it: there it goes on in parallel to the usual chart of {} LiPo "
            "cells, {:.0f} mV a cell unsure.",
            identified.observed_min_soc_percent, identified.cells, units::mv_from_v(battery::lipo_chart_sd_v));
    }
    auto figure = new_figure(
        "open_circuit", id, caption,
        fmt::format("Open-circuit voltage over state of charge: {:.2f} V empty, {:.2f} V full, flown down to "
                    "{:.0f} %.",
                    curve.voltage_v.front(), curve.voltage_v.back(), identified.observed_min_soc_percent),
        {{"knots", knot_rows(identified).json()}});
    // The first layer is the intervals.
    if (identified.battery.intervals.open_circuit_standard_error_v.empty()) figure.spec["layer"].erase(0);
    return figure;
}

}  // namespace flightwatt::report
