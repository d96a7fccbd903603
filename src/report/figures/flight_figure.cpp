#include "flight/edge_events.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"
#include "report/figures/flight_figures.h"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Where a phase begins or ends, in words.
std::string explained(const flight::PhaseEdge& edge) {
    auto text = fmt::format("altitude {:.1f} m", edge.altitude_m);
    if (edge.throttle_percent) text += fmt::format(", throttle {:.0f} %", *edge.throttle_percent);
    if (edge.takeoff_after_s && std::abs(*edge.takeoff_after_s) < flight::max_event_distance_s) {
        text += fmt::format(", nearest TAKEOFF message {:.1f} s {}", std::abs(*edge.takeoff_after_s),
                            *edge.takeoff_after_s < 0.0 ? "before" : "after");
    }
    if (edge.mode) text += fmt::format(", mode {}", *edge.mode);
    if (edge.block) text += fmt::format(", block {}", *edge.block);
    return text + fmt::format("; known within {:.1f} s", edge.gap_s);
}

std::string edge_name(const flight::PhaseSpan& span, bool begin) {
    switch (span.phase) {
        case flight::Phase::takeoff:
            return begin ? "lift-off" : "end of take-off";
        case flight::Phase::landing:
            return begin ? "start of landing" : "touchdown";
        case flight::Phase::cruise:
            break;
    }
    return begin ? "start of cruise" : "end of cruise, start of landing";
}

/// An incomplete phase begins or ends there because the log does.
bool is_end_of_log(const flight::Track& clock, double time_s) {
    constexpr double near_s = 2.0;  // altitude and power have clocks of their own
    return time_s - clock.time_s.front() < near_s || clock.time_s.back() - time_s < near_s;
}

/// What the autopilot says of the edge, if that was recorded.
std::string verdict_at(const ReportFlight& flight, double time_s) {
    constexpr double same_edge_s = 2e-3;  // edges are rounded to the millisecond
    for (const auto& verdict : flight.verdicts) {
        if (std::abs(verdict.time_s - time_s) < same_edge_s) return verdict.text;
    }
    return "-";
}

constexpr std::size_t power_columns = 250;
/// More than a panel's height in pixels, and than its width when it is zoomed fifty times.
constexpr double value_steps = 500.0;
constexpr double time_steps = 32000.0;
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
FigureData power_rows(const ReportFlight& flight, const flight::Track& power,
                      const std::optional<mechanical::MechanicalModel>& model) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.round_to({decimals_for(power.time_s, time_steps, 1), decimals_for(power.value, value_steps, 1)});
    for (const auto i : downsample_m4(power.time_s, power.value, power_columns)) {
        data.add({power.time_s[i], power.value[i]}, {"measured"});
    }
    if (!model) return data;
    constexpr int points = 60;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (!span.complete || span.duration_s() <= 0.0) continue;
            const auto curve = time_scaled_model(model->phases[span.phase], span.duration_s(),
                                                 mechanical::PhaseTimeScaling::stretched);
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
    data.round_to({decimals_for(time_s, time_steps, 1), decimals_for(values, value_steps, 1)});
    for (const auto i : downsample_m4(time_s, values, power_columns)) data.add({time_s[i], values[i]});
    return data;
}

VegaJson phase_layers(const FigureData& phases, const FigureData& edges, bool with_names) {
    const auto fill = vega(R"({"legend": null,
        "scale": {"domain": ["takeoff", "cruise", "landing"], "range": "phases"}})");
    auto layers = VegaJson::array();
    layers.push_back(layer(phases.reference("phases"),
                           R"({"type": "rect", "opacity": 0.13, "aria": false, "clip": true})",
                           {{"x", numeric_channel("start_s", log_time_title)},
                            {"x2", {{"field", "end_s"}}},
                            {"fill", nominal_channel("phase", "phase", fill)}}));
    layers.push_back(
        layer(edges.reference("edges"),
              R"({"type": "rule", "style": "edge", "strokeDash": [3, 3], "strokeWidth": 1.5, "clip": true})",
              {{"x", numeric_channel("time_s", log_time_title)},
               {"tooltip",
                {nominal_channel("edge", "edge"), tooltip_number("time_s", "time [s]", ".1f"),
                 nominal_channel("evidence", "evidence"), nominal_channel("verdict", "the autopilot")}}}));
    if (with_names) layers.push_back(phase_names(phases.reference("phases"), log_time_title));
    return layers;
}

/// One panel; its layers share the time axis, which only the last panel writes out.
VegaJson panel(VegaJson layers, int height, bool is_last) {
    for (auto& part : layers) {
        part["encoding"]["x"]["axis"] =
            vega(is_last ? R"({"grid": false})" : R"({"grid": false, "labels": false, "title": null})");
        part["encoding"]["x"]["scale"] = {{"zero", false}, {"nice", false}};
    }
    return {{"width", flight_width}, {"height", height}, {"layer", layers}};
}

/// A line; transparent points on it carry its tooltips.
VegaJson line_layer(const FigureData& data, const std::string& column, const std::string& title) {
    return layer(data.json(),
                 R"({"type": "line", "style": "measured", "strokeWidth": 1.2, "clip": true,
                     "point": {"opacity": 0, "size": 60, "aria": false}})",
                 {{"x", numeric_channel("time_s", log_time_title)},
                  {"y", numeric_channel(column, title, {{"scale", {{"zero", false}}}})},
                  {"tooltip", {tooltip_number("time_s", "time [s]", ".1f"), tooltip_number(column, title, ".1f")}}});
}

VegaJson power_layer(const FigureData& data) {
    auto line = line_layer(data, "power_w", "power [W]");
    line["mark"].erase("style");
    auto& encoding = line["encoding"];
    add_measured_and_model(encoding, 1.1, 2.2);
    line["transform"] = VegaJson::array({shown_by_legend()});
    encoding["tooltip"].insert(encoding["tooltip"].begin(), nominal_channel("curve", "curve"));
    return line;
}

std::string description_of(const ReportFlight& flight) {
    std::string text = fmt::format("Altitude, throttle and power of flight {} over time.", flight.name);
    const flight::PowerStatistics power(flight.series);
    std::size_t number = 0;
    for (const auto& sortie : flight.phases.sorties) {
        ++number;
        for (const auto& span : sortie.phases) {
            const auto statistics = power.between(span.start.time_s, span.end.time_s);
            text += fmt::format(" Sortie {}, {}: {:.0f} s from {:.1f} s on, {:.1f} W on average.", number,
                                phase_word(span.phase), span.duration_s(), span.start.time_s, statistics.mean_power_w);
        }
    }
    return text;
}

std::string caption_of(const flight::Track& power, bool has_model) {
    std::string text = "Phases are shaded and end at the dashed lines; those tell their evidence when pointed at.";
    if (has_model) text += " The model is each phase's curve, stretched to the time flown.";
    const auto samples = power.time_s.size();
    const auto drawn = downsample_m4(power.time_s, power.value, power_columns).size();
    if (drawn < samples) {
        text += fmt::format(" Drawn with {} of {} samples: the extremes of each column of the screen.", drawn, samples);
    }
    return text;
}

constexpr int in_flight_width = 640;
constexpr int in_flight_height = 190;
constexpr auto in_flight_time_title = "time since lift-off [s]";
constexpr auto in_flight_energy_title = "energy of the whole flight [Wh]";

}  // namespace

std::vector<NamedEdge> edges_of(const ReportFlight& flight) {
    std::vector<NamedEdge> edges;
    if (flight.phases.sorties.empty()) return edges;
    auto clock = power_track(flight.series);
    if (clock.empty()) clock = select_track(flight.series, "altitude_m");
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < sortie.phases.size(); ++i) {
            const auto& span = sortie.phases[i];
            const bool continues = i > 0 && sortie.phases[i - 1].end.time_s == span.start.time_s;
            const auto add = [&](const flight::PhaseEdge& edge, bool begin) {
                const bool cut = !span.complete && is_end_of_log(clock, edge.time_s);
                edges.push_back({edge.time_s,
                                 cut ? (begin ? "the log begins" : "the log ends") : edge_name(span, begin),
                                 explained(edge), verdict_at(flight, edge.time_s)});
            };
            if (!continues) add(span.start, true);
            add(span.end, false);
        }
    }
    return edges;
}

Figure flight_figure(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                     const std::string& id) {
    const flight::SelectedTracks tracks(flight.series);
    const auto& power = tracks["power_w"];
    const auto& time_s = power.time_s;
    auto figure = new_figure(id, caption_of(power, model.has_value()), description_of(flight));
    const auto phases = phase_rows(flight.phases);
    const auto edges = edge_rows(flight);
    auto panels = VegaJson::array();
    const auto add_channel = [&](const std::string& column, const std::string& title, int height) {
        const auto& track = tracks[column];
        if (track.empty()) return;
        const auto values = resample(track, time_s);
        auto layers = phase_layers(phases, edges, panels.empty());
        layers.push_back(line_layer(channel_rows(time_s, values, column), column, title));
        panels.push_back(panel(layers, height, false));
    };
    add_channel("altitude_m", "altitude [m]", 110);
    add_channel("throttle_percent", "throttle [%]", 80);
    auto layers = phase_layers(phases, edges, panels.empty());
    layers.push_back(power_layer(power_rows(flight, power, model)));
    panels.push_back(panel(layers, 190, true));
    auto views = VegaJson::array();
    for (auto& view : panels) {
        views.push_back(fmt::format("panel_{}", views.size()));
        view["layer"].back()["name"] = views.back();  // of a panel, its last layer
    }
    figure.spec["params"] = {add_zoom(figure, views),
                             legend_parameter("curve", {"measured", "model"}, views.back().get<std::string>())};
    figure.spec["datasets"] = {{"phases", phases.csv()}, {"edges", edges.csv()}};
    figure.spec["vconcat"] = panels;
    figure.spec["spacing"] = 10;
    figure.spec["resolve"] = vega(R"({"scale": {"x": "shared"}})");
    return figure;
}

Figure in_flight_figure(const std::string& name, const PredictedFlight& flight, const std::string& id) {
    FigureData data({"flown_s", "energy_wh", "low_wh", "high_wh", "measured_wh"});
    std::size_t held = 0;
    for (const auto& [flown_s, energy_wh, interval] : flight.moments) {
        data.add({flown_s, energy_wh, interval.low_wh, interval.high_wh, flight.measured_wh});
        if (interval.contains(flight.measured_wh)) ++held;
    }
    const auto& first = flight.moments.front();
    const auto& last = flight.moments.back();
    auto figure = new_figure(
        id,
        fmt::format(
            "What flightwatt predict would have said in every minute of the cruise, from what was flown until then "
            "and a model of the {} other flights; the durations of cruise and landing taken as known. Level line: "
            "measured. {} of {} intervals of 95 % hold it (neighbours share what they rest on).",
            flight.others, held, flight.moments.size()),
        fmt::format(
            "Predicted energy of flight {}: {:.2f} Wh after {:.0f} s, {:.2f} Wh after {:.0f} s; measured {:.2f} Wh.",
            name, first.energy_wh, first.flown_s, last.energy_wh, last.flown_s, flight.measured_wh));
    figure.spec["data"] = data.json();
    figure.spec["width"] = in_flight_width;
    figure.spec["height"] = in_flight_height;
    const auto time = numeric_channel("flown_s", in_flight_time_title, {{"scale", {{"nice", false}}}});
    const VegaJson energy{{"scale", {{"zero", false}}}};
    figure.spec["layer"] = {
        layer(R"({"type": "area", "style": "measured", "opacity": 0.2, "aria": false})",
              {{"x", time},
               {"y", numeric_channel("low_wh", in_flight_energy_title, energy)},
               {"y2", {{"field", "high_wh"}}}}),
        layer(R"({"type": "line", "style": "edge", "aria": false})",
              {{"x", time}, {"y", numeric_channel("measured_wh", in_flight_energy_title, energy)}}),
        layer(R"({"type": "line", "style": "measured", "point": {"size": 26}})",
              {{"x", time},
               {"y", numeric_channel("energy_wh", in_flight_energy_title, energy)},
               {"tooltip",
                {tooltip_number("flown_s", in_flight_time_title, ".0f"),
                 tooltip_number("energy_wh", "predicted [Wh]", ".3f"), tooltip_number("low_wh", "low [Wh]", ".3f"),
                 tooltip_number("high_wh", "high [Wh]", ".3f"),
                 tooltip_number("measured_wh", "measured [Wh]", ".3f")}}})};
    return figure;
}

}  // namespace flightwatt::report
