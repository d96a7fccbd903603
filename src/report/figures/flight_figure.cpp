#include "report/figures/flight_figure.h"

#include "flight/chosen_track.h"
#include "flight/phase_statistics.h"
#include "report/figures/decimation.h"
#include "report/sections/flight_edges.h"
#include "report/sections/phase_words.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::size_t power_columns = 250;
constexpr int flight_width = 640;

constexpr auto log_time_title = "time in the log [s]";

/// One row a phase: for the shading and its names.
FigureData phase_rows(const flight::FlightPhases& phases) {
    FigureData data({"start_s", "end_s", "middle_s"}, {"phase", "word"});
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            data.add({span.start.time_s, span.end.time_s, std::midpoint(span.start.time_s, span.end.time_s)},
                     {to_string(span.phase), phase_word(span.phase)});
        }
    }
    return data;
}

FigureData edge_rows(const ReportFlight& flight) {
    FigureData data({"time_s"}, {"edge", "evidence", "verdict"});
    for (const auto& edge : edges_of(flight)) {
        data.add({edge.time_s}, {edge.name, edge.evidence, edge.verdict});
    }
    return data;
}

/// Measured power, and the model's curve of every phase of the flight.
FigureData power_rows(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    const auto power = power_track(flight.series);
    for (const auto i : visible_rows(power.time_s, power.value, power_columns)) {
        data.add({power.time_s[i], power.value[i]}, {"measured"});
    }
    if (!model) return data;
    constexpr int points = 60;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (!span.complete || span.duration_s() <= 0.0) continue;
            const auto curve =
                flown_model(model->phases[span.phase], span.duration_s(), mechanical::PhaseClock::stretched);
            for (int i = 0; i <= points; ++i) {
                const double time_s = span.duration_s() * i / points;
                data.add({span.start.time_s + time_s, power_w(curve, time_s)}, {"model"});
            }
            data.add({span.end.time_s, std::nan("")}, {"model"});  // phases do not join
        }
    }
    return data;
}

FigureData channel_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                        const std::string& column) {
    FigureData data({"time_s", column});
    for (const auto i : visible_rows(time_s, values, power_columns)) {
        data.add({time_s[i], values[i]});
    }
    return data;
}

VegaJson phase_layers(const FigureData& phases, const FigureData& edges, bool with_names) {
    VegaJson layers = VegaJson::array();
    layers.push_back(
        {{"data", phases.reference("phases")},
         {"mark", {{"type", "rect"}, {"opacity", 0.13}, {"aria", false}, {"clip", true}}},
         {"encoding",
          {{"x", quantity("start_s", log_time_title)},
           {"x2", {{"field", "end_s"}}},
           {"fill",
            category("phase", "phase",
                     {{"legend", nullptr},
                      {"scale", {{"domain", {"takeoff", "cruise", "landing"}}, {"range", "phases"}}}})}}}});
    layers.push_back({{"data", edges.reference("edges")},
                      {"mark",
                       {{"type", "rule"},
                        {"style", "edge"},
                        {"strokeDash", {3, 3}},
                        {"strokeWidth", 1.5},
                        {"clip", true}}},
                      {"encoding",
                       {{"x", quantity("time_s", log_time_title)},
                        {"tooltip",
                         {category("edge", "edge"), quantity("time_s", "time [s]", {{"format", ".1f"}}),
                          category("evidence", "evidence"), category("verdict", "the autopilot")}}}}});
    if (with_names) {
        layers.push_back(
            {{"data", phases.reference("phases")},
             {"mark",
              {{"type", "text"},
               {"style", "note"},
               {"baseline", "bottom"},
               {"dy", -3},
               {"y", 0},
               {"clip", false}}},
             {"encoding",
              {{"x", quantity("middle_s", log_time_title)}, {"text", category("word", "phase")}}}});
    }
    return layers;
}

/// One panel; its layers share the time axis, which only the last panel writes out.
VegaJson panel(VegaJson layers, int height, bool is_last) {
    for (auto& layer : layers) {
        layer["encoding"]["x"]["axis"] =
            is_last ? VegaJson{{"grid", false}}
                    : VegaJson{{"grid", false}, {"labels", false}, {"title", nullptr}};
        layer["encoding"]["x"]["scale"] = {{"zero", false}, {"nice", false}};
    }
    return {{"width", flight_width}, {"height", height}, {"layer", layers}};
}

/// A line; transparent points on it carry its tooltips.
VegaJson line_layer(const FigureData& data, const std::string& column, const std::string& title,
                    const std::string& hover) {
    return {{"data", data.json()},
            {"mark",
             {{"type", "line"},
              {"style", "measured"},
              {"strokeWidth", 1.2},
              {"clip", true},
              {"point", {{"opacity", 0}, {"size", 60}, {"aria", false}}}}},
            {"encoding",
             {{"x", quantity("time_s", log_time_title)},
              {"y", quantity(column, title, {{"scale", {{"zero", false}}}})},
              {"tooltip",
               {quantity("time_s", "time [s]", {{"format", ".1f"}}),
                quantity(column, hover, {{"format", ".1f"}})}}}}};
}

VegaJson power_layer(const FigureData& data) {
    auto layer = line_layer(data, "power_w", "power [W]", "power [W]");
    layer["mark"].erase("style");
    auto& encoding = layer["encoding"];
    const VegaJson curves{{"domain", {"measured", "model"}}};
    VegaJson color = curves;
    color["range"] = "measured_and_model";
    VegaJson width = curves;
    width["range"] = {1.1, 2.2};
    encoding["color"] = category("curve", "", {{"scale", color}, {"legend", {{"symbolType", "stroke"}}}});
    encoding["strokeWidth"] = {{"field", "curve"},
                               {"type", "ordinal"},
                               {"title", ""},
                               {"scale", width},
                               {"legend", {{"symbolType", "stroke"}}}};
    layer["transform"] = VegaJson::array({shown_by_legend()});
    encoding["tooltip"].insert(encoding["tooltip"].begin(), category("curve", "curve"));
    return layer;
}

std::string description_of(const ReportFlight& flight) {
    std::string text = fmt::format("Altitude, throttle and power of flight {} over time.", flight.name);
    std::size_t number = 0;
    for (const auto& sortie : flight.phases.sorties) {
        ++number;
        for (const auto& span : sortie.phases) {
            const auto statistics = phase_statistics(flight.series, span.start.time_s, span.end.time_s);
            text += fmt::format(" Sortie {}, {}: {:.0f} s from {:.1f} s on, {:.1f} W on average.", number,
                                phase_word(span.phase), span.duration_s(), span.start.time_s,
                                statistics.mean_power_w);
        }
    }
    return text;
}

std::string caption_of(const ReportFlight& flight, bool has_model) {
    std::string text =
        "Phases are shaded and end at the dashed lines; those tell their evidence when pointed at.";
    if (has_model) text += " The model is each phase's curve, stretched to the time flown.";
    const auto power = power_track(flight.series);
    const auto samples = power.time_s.size();
    const auto drawn = visible_rows(power.time_s, power.value, power_columns).size();
    if (drawn < samples) {
        text += fmt::format(" Drawn with {} of {} samples: the extremes of each column of the screen.", drawn,
                            samples);
    }
    return text;
}

}  // namespace

Figure flight_figure(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                     const std::string& id) {
    Figure figure{id, caption_of(flight, model.has_value()), description_of(flight), "zoom_time_s", "x", {}};
    const auto phases = phase_rows(flight.phases);
    const auto edges = edge_rows(flight);
    const auto time_s = power_track(flight.series).time_s;
    VegaJson panels = VegaJson::array();
    const auto add_channel = [&](const std::string& column, const std::string& title, int height) {
        const auto values = chosen_at(flight.series, column, time_s);
        if (values.empty()) return;
        auto layers = phase_layers(phases, edges, panels.empty());
        layers.push_back(line_layer(channel_rows(time_s, values, column), column, title, title));
        panels.push_back(panel(layers, height, false));
    };
    add_channel("altitude_m", "altitude [m]", 110);
    add_channel("throttle_percent", "throttle [%]", 80);
    auto layers = phase_layers(phases, edges, panels.empty());
    layers.push_back(power_layer(power_rows(flight, model)));
    panels.push_back(panel(layers, 190, true));
    VegaJson views = VegaJson::array();
    for (std::size_t i = 0; i < panels.size(); ++i) {
        views.push_back(fmt::format("panel_{}", i));
        panels[i]["layer"].back()["name"] = views.back();  // of a panel, its last layer
    }
    auto zoom = zoom_parameter("x");
    zoom["views"] = views;

    figure.spec = new_spec(figure);
    figure.spec["params"] = {
        zoom, legend_parameter("curve", {"measured", "model"}, views.back().get<std::string>())};
    figure.spec["datasets"] = {{"phases", phases.csv()}, {"edges", edges.csv()}};
    figure.spec["vconcat"] = panels;
    figure.spec["spacing"] = 10;
    figure.spec["resolve"] = {{"scale", {{"x", "shared"}}}};
    return figure;
}

}  // namespace flightwatt::report
