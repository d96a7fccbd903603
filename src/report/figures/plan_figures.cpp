#include "compute/qos_range.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr int plan_width = 640;
constexpr auto mission_time_title = "time since lift-off [s]";
constexpr auto final_soc_title = "final state of charge [%]";

VegaJson utility_axes() {
    return {{"x", numeric_channel("soc_percent", final_soc_title)},
            {"y", numeric_channel("utility", "utility (mean value a second)")}};
}

VegaJson points_layer(const std::vector<UtilityPoint>& points) {
    FigureData data({"soc_percent", "utility"}, {"mission", "kind"});
    for (const bool planned : {true, false}) {  // a planned one stands behind a given one that is as good
        for (const auto& point : points) {
            if (point.planned != planned) continue;
            data.add({point.soc_percent, point.utility}, {point.mission, planned ? "planned" : "given"});
        }
    }
    auto scale = vega(R"({"scale": {"domain": ["planned", "given"]}})");
    auto encoding = utility_axes();
    encoding["color"] = nominal_channel("kind", "", scale);
    scale["scale"]["range"] = {"diamond", "circle"};
    encoding["shape"] = nominal_channel("kind", "", scale);
    scale["scale"]["range"] = {190, 60};
    encoding["size"] = {{"field", "kind"}, {"type", "ordinal"}, {"title", ""}};
    encoding["size"].update(scale);
    encoding["tooltip"] = {nominal_channel("mission", "mission"), nominal_channel("kind", "schedule"),
                           tooltip_number("utility", "utility", ".4g"),
                           tooltip_number("soc_percent", final_soc_title, ".2f")};
    return layer(data.json(), R"({"type": "point", "filled": true, "opacity": 1})", encoding);
}

/// Points that a reader cannot tell apart share a name.
std::vector<UtilityPoint> named_together(const std::vector<UtilityPoint>& points) {
    constexpr double near_fraction = 0.02;  // of what the points span
    const auto span_of = [&](double UtilityPoint::*value) {
        const auto [low, high] = std::ranges::minmax_element(
            points, [&](const UtilityPoint& a, const UtilityPoint& b) { return a.*value < b.*value; });
        return (*high).*value - (*low).*value;
    };
    const double soc_span = span_of(&UtilityPoint::soc_percent);
    const double utility_span = span_of(&UtilityPoint::utility);
    std::vector<UtilityPoint> together;
    for (const auto& point : points) {
        const auto twin = std::ranges::find_if(together, [&](const UtilityPoint& other) {
            return std::abs(other.soc_percent - point.soc_percent) <= near_fraction * soc_span &&
                   std::abs(other.utility - point.utility) <= near_fraction * utility_span;
        });
        if (twin == together.end()) {
            together.push_back(point);
        } else {
            twin->mission += ", " + point.mission;
        }
    }
    return together;
}

/// Names to the right of their points, at the figure's right end to the left.
VegaJson names_layer(const std::vector<UtilityPoint>& points) {
    FigureData data({"soc_percent", "utility"}, {"mission", "side"});
    constexpr double right_end = 0.65;
    double max_percent = 0.0;
    for (const auto& point : points) max_percent = std::max(max_percent, point.soc_percent);
    for (const auto& point : named_together(points)) {
        data.add({point.soc_percent, point.utility},
                 {point.mission, point.soc_percent > right_end * max_percent ? "left" : "right"});
    }
    auto encoding = utility_axes();
    encoding["text"] = nominal_channel("mission", "mission");
    const auto texts = [&](std::string_view side, std::string_view mark) {
        VegaJson filtered{{"transform", VegaJson::array({{{"filter", {{"field", "side"}, {"equal", side}}}}})}};
        filtered.update(layer(mark, encoding));
        return filtered;
    };
    return {
        {"data", data.json()},
        {"layer",
         {texts("left", R"({"type": "text", "style": "note", "align": "right", "dx": -8, "dy": 11, "limit": 220})"),
          texts("right", R"({"type": "text", "style": "note", "align": "left", "dx": 8, "dy": 11, "limit": 220})")}}};
}

/// A line across the figure, its place on `channel`, with its name written by `mark`.
VegaJson rule_layer(std::string_view channel, double value, const std::string& text, std::string_view mark) {
    const auto with = [&](std::string_view more) -> VegaJson {
        return {{channel, {{"datum", value}}}, {more, nominal_channel("text", "line")}};
    };
    return {{"data", {{"values", VegaJson::array({{{"text", text}}})}}},
            {"layer",
             {layer(R"({"type": "rule", "style": "edge", "strokeDash": [5, 3], "strokeWidth": 1.5})", with("tooltip")),
              layer(mark, with("text"))}}};
}

VegaJson bars_layer(const mission::Mission& mission, double duration_s) {
    FigureData data({"from_s", "to_s", "middle_s", "power_w", "long_s"}, {"component", "runs"});
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.compute.components[running.component];
        data.add({running.start_s, running.end_s, std::midpoint(running.start_s, running.end_s),
                  power_w(component.profile, running.qos), running.end_s - running.start_s},
                 {component.name, describe_qos(component, running.qos)});
    }
    const VegaJson whole{{"scale", {{"domain", {0.0, duration_s}}, {"nice", false}}}, {"axis", {{"grid", false}}}};
    const auto y = nominal_channel("component", "", vega(R"({"sort": null, "axis": {"labelLimit": 130}})"));
    const auto bars = layer(R"({"type": "bar", "clip": true, "height": 15, "yOffset": 9})",
                            {{"x", numeric_channel("from_s", mission_time_title, whole)},
                             {"x2", {{"field", "to_s"}}},
                             {"y", y},
                             {"color", power_ramp("power_w", "power of the component [W]")},
                             {"tooltip",
                              {nominal_channel("component", "component"), nominal_channel("runs", "runs"),
                               tooltip_number("from_s", "from [s]", ".0f"), tooltip_number("to_s", "to [s]", ".0f"),
                               tooltip_number("power_w", "power [W]", ".2f")}}});
    constexpr double min_part = 0.13;  // of the time: a shorter bar has no room for its words
    VegaJson words{
        {"transform", VegaJson::array({{{"filter", fmt::format("datum.long_s > {}", min_part * duration_s)}}})}};
    words.update(layer(R"({"type": "text", "style": "note", "dy": -8})",
                       {{"x", numeric_channel("middle_s", mission_time_title, whole)},
                        {"y", y},
                        {"text", nominal_channel("runs", "runs")}}));
    return {{"data", data.json()}, {"layer", {bars, words}}};
}

VegaJson edge_layer(const mission::Mission& mission) {
    FigureData data({"begin_s", "middle_s"}, {"phase"});
    const auto timeline = mission::timeline_of(mission.duration_s);
    for (const auto phase : flight::all_phases) {
        if (mission.duration_s[phase] <= 0.0) continue;
        data.add({timeline.start_s[phase], timeline.start_s[phase] + mission.duration_s[phase] / 2.0},
                 {phase_word(phase)});
    }
    return {{"data", data.json()},
            {"layer",
             {layer(R"({"type": "rule", "style": "edge", "strokeDash": [3, 3], "aria": false})",
                    {{"x", numeric_channel("begin_s", mission_time_title)}}),
              layer(R"({"type": "text", "style": "note", "baseline": "bottom", "dy": -3, "y": 0})",
                    {{"x", numeric_channel("middle_s", mission_time_title)},
                     {"text", nominal_channel("phase", "phase")}})}}};
}

}  // namespace

std::vector<RunInterval> run_intervals(const mission::Mission& mission) {
    const auto timeline = mission::timeline_of(mission.duration_s);
    std::vector<RunInterval> times;
    std::map<std::size_t, std::size_t> last;  // of each component, its index in `times`
    for (const auto& segment : mission.schedule) {
        const double start_s = timeline.start_s[segment.phase] + segment.start_s;
        const double end_s = timeline.start_s[segment.phase] + segment.end_s;
        for (const auto& run : segment.run) {
            const auto before = last.find(run.component);
            if (before != last.end() && times[before->second].qos == run.qos &&
                start_s - times[before->second].end_s < mission::same_time_tolerance_s(end_s)) {
                times[before->second].end_s = end_s;
                continue;
            }
            last[run.component] = times.size();
            times.push_back({run.component, start_s, end_s, run.qos});
        }
    }
    return times;
}

std::string describe_qos(const compute::Component& component, const std::vector<double>& qos) {
    return qos.empty() ? "on" : compute::format_qos(component.profile.parameters, qos, " ", ", ");
}

Figure utility_figure(const SimulatedMission& planned, const std::vector<UtilityPoint>& points, const std::string& id) {
    std::string description = "Utility over final state of charge.";
    for (const auto& point : points) {
        description += fmt::format(" {}: {:.4g} at {:.2f} %.", point.mission, point.utility, point.soc_percent);
    }
    auto figure =
        new_figure(id,
                   "The utility of the schedules, by that of the planned mission, over what they leave. To the left "
                   "of the reserve a schedule spends what was to be kept; above the bound there is none that keeps it. "
                   "What runs after the battery's end counts nothing.",
                   description);
    figure.spec["width"] = plan_width;
    figure.spec["height"] = 260;
    auto& layers = figure.spec["layer"] = VegaJson::array();
    layers.push_back(rule_layer("x", planned.simulation.summary.reserve_soc_percent, "reserve",
                                R"({"type": "text", "style": "note", "align": "left", "dx": 4, "dy": 10, "y": 0})"));
    if (planned.planned->feasible) {
        layers.push_back(rule_layer(
            "y", planned.planned->bound, "proven bound",
            R"({"type": "text", "style": "note", "align": "right", "dx": -4, "dy": -5, "x": {"expr": "width"}})"));
    }
    layers.push_back(points_layer(points));
    layers.push_back(names_layer(points));
    return figure;
}

Figure strip_figure(const SimulatedMission& planned, const std::string& id) {
    const auto& mission = planned.mission;
    auto description = fmt::format("What {} runs when.", planned.title);
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.compute.components[running.component];
        description += fmt::format(" {} {} from {:.0f} to {:.0f} s.", component.name,
                                   describe_qos(component, running.qos), running.start_s, running.end_s);
    }
    auto figure =
        new_figure(id, "What runs when, coloured by its power; a component without a bar is off.", description);
    figure.spec["width"] = plan_width;
    figure.spec["height"] = {{"step", 42}};
    figure.spec["usermeta"] = {{"margin_px", 150}};  // the components' names
    figure.spec["layer"] = {bars_layer(mission, mission::timeline_of(mission.duration_s).duration_s),
                            edge_layer(mission)};
    return figure;
}

}  // namespace flightwatt::report
