#include "report/figures/battery_figures.h"

#include "base/units.h"
#include "report/figures/decimation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::size_t battery_columns = 130;  // of a panel
constexpr auto record_time_title = "time in the log [s]";
constexpr auto soc_title = "state of charge [%]";
constexpr auto open_circuit_title = "open-circuit voltage [V]";

/// A curve as a screen shows it, broken where the record is not used.
void add_curve(FigureData& data, const battery::DischargeRecord& record, const std::vector<double>& voltage_v,
               std::string_view name) {
    for (const auto i : visible_rows(record.time_s, voltage_v, battery_columns)) {
        data.add({record.time_s[i], record.used[i] ? voltage_v[i] : std::nan("")}, {name});
    }
}

VegaJson voltage_panel(const battery::Battery& battery, const battery::DischargeRecord& record) {
    FigureData data({"time_s", "voltage_v"}, {"curve"});
    add_curve(data, record, record.voltage_v, "measured");
    add_curve(data, record, predict_voltage(battery, record).voltage_v, "model");
    const VegaJson curves{{"domain", {"measured", "model"}}, {"range", "measured_and_model"}};
    // What is measured stands out behind the model where both are one.
    const VegaJson widths{{"domain", {"measured", "model"}}, {"range", {3.2, 1.1}}};
    return {{"title", valid_utf8(record.flight)},
            {"width", 280},
            {"height", 150},
            {"data", data.json()},
            {"mark", {{"type", "line"}, {"point", {{"opacity", 0}, {"size", 40}, {"aria", false}}}}},
            {"encoding",
             {{"x", quantity("time_s", record_time_title)},
              {"y", quantity("voltage_v", "voltage [V]", {{"scale", {{"zero", false}}}})},
              {"color", category("curve", "", {{"scale", curves}, {"legend", {{"symbolType", "stroke"}}}})},
              {"strokeWidth",
               {{"field", "curve"},
                {"type", "ordinal"},
                {"title", ""},
                {"scale", widths},
                {"legend", {{"symbolType", "stroke"}}}}},
              {"tooltip",
               {category("curve", "curve"), quantity("time_s", "time [s]", {{"format", ".1f"}}),
                quantity("voltage_v", "voltage [V]", {{"format", ".3f"}})}}}}};
}

/// The knots with their 95 % intervals, where those are known.
FigureData knot_rows(const battery::BatteryIdentification& identified) {
    constexpr double wide_95 = 1.96;
    const auto& curve = identified.battery.thevenin->open_circuit;
    const auto& errors_v = identified.battery.intervals.open_circuit_standard_error_v;
    FigureData data({"soc_percent", "voltage_v", "low_v", "high_v"}, {"origin"});
    for (std::size_t i = 0; i < curve.soc_percent.size(); ++i) {
        const double reach_v = errors_v.empty() ? std::nan("") : wide_95 * errors_v[i];
        // Knots are rounded to their state of charge: the last one that was flown belongs to the flights.
        const bool flown = curve.soc_percent[i] >= identified.known_down_to_percent - 1e-6;
        data.add({curve.soc_percent[i], curve.voltage_v[i], curve.voltage_v[i] - reach_v,
                  curve.voltage_v[i] + reach_v},
                 {flown ? "from flights" : "after the LiPo chart"});
    }
    return data;
}

VegaJson band_layer() {
    return {{"mark", {{"type", "area"}, {"style", "measured"}, {"opacity", 0.2}, {"aria", false}}},
            {"encoding",
             {{"x", quantity("soc_percent", soc_title)},
              {"y", quantity("low_v", open_circuit_title, {{"scale", {{"zero", false}}}})},
              {"y2", {{"field", "high_v"}}}}}};
}

VegaJson curve_layers() {
    const auto x = quantity("soc_percent", soc_title);
    const auto y = quantity("voltage_v", open_circuit_title, {{"scale", {{"zero", false}}}});
    const VegaJson line{{"mark", {{"type", "line"}, {"style", "measured"}}},
                        {"encoding", {{"x", x}, {"y", y}}}};
    const VegaJson origins{{"domain", {"from flights", "after the LiPo chart"}}};
    auto shapes = origins;
    shapes["range"] = {"circle", "diamond"};
    const VegaJson knots{
        {"mark", {{"type", "point"}, {"size", 50}, {"filled", true}, {"opacity", 1}}},
        {"encoding",
         {{"x", x},
          {"y", y},
          {"color", category("origin", "", {{"scale", origins}})},
          {"shape", category("origin", "", {{"scale", shapes}})},
          {"tooltip",
           {category("origin", "known"), quantity("soc_percent", soc_title, {{"format", ".1f"}}),
            quantity("voltage_v", "voltage [V]", {{"format", ".3f"}}),
            quantity("low_v", "95 %, low [V]", {{"format", ".3f"}}),
            quantity("high_v", "95 %, high [V]", {{"format", ".3f"}})}}}}};
    return VegaJson::array({line, knots});
}

}  // namespace

Figure voltage_figure(const battery::Battery& battery, std::span<const battery::DischargeRecord> records,
                      const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.caption =
        "The model predicts the voltage from the measured current and the voltage at rest before the flight "
        "alone. Both are broken where the record contradicts itself: a current that the motor did not draw.";
    figure.description =
        fmt::format("Terminal voltage of {} flights over time, measured and modelled.", records.size());
    figure.spec = new_spec(figure);
    figure.spec["columns"] = 2;
    figure.spec["bounds"] = "flush";
    figure.spec["spacing"] = {{"column", 62}, {"row", 66}};
    figure.spec["concat"] = VegaJson::array();
    for (const auto& record : records) {
        const auto [low, high] = std::minmax_element(record.voltage_v.begin(), record.voltage_v.end());
        figure.description += fmt::format(" {}: {:.2f} to {:.2f} V.", record.flight, *low, *high);
        figure.spec["concat"].push_back(voltage_panel(battery, record));
    }
    return figure;
}

Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id) {
    const auto& curve = identified.battery.thevenin->open_circuit;
    Figure figure;
    figure.id = id;
    figure.caption = "Open-circuit voltage with the 95 % intervals of its knots.";
    if (identified.known_down_to_percent > 0.0) {
        figure.caption += fmt::format(
            " Below {:.0f} % no flight shows it: there it goes on in parallel to the usual chart of {} LiPo "
            "cells, 30 mV a cell unsure.",
            identified.known_down_to_percent, identified.cells);
    }
    figure.description = fmt::format(
        "Open-circuit voltage over state of charge: {:.2f} V empty, {:.2f} V full, flown down to "
        "{:.0f} %.",
        curve.voltage_v.front(), curve.voltage_v.back(), identified.known_down_to_percent);
    figure.spec = new_spec(figure);
    figure.spec["width"] = 560;
    figure.spec["height"] = 240;
    figure.spec["data"] = knot_rows(identified).json();
    auto layers = curve_layers();
    if (!identified.battery.intervals.open_circuit_standard_error_v.empty()) {
        layers.insert(layers.begin(), band_layer());
    }
    figure.spec["layer"] = layers;
    return figure;
}

}  // namespace flightwatt::report
