#include "report/figures/plan_figures.h"

#include "compute/qos_range.h"
#include "report/sections/phase_words.h"

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
constexpr auto utility_title = "utility (mean worth a second)";

VegaJson utility_axes() {
    return {{"x", quantity("soc_percent", final_soc_title)}, {"y", quantity("utility", utility_title)}};
}

VegaJson points_layer(const std::vector<UtilityPoint>& points) {
    FigureData data({"soc_percent", "utility"}, {"mission", "kind"});
    for (const bool planned : {true, false}) {  // a planned one stands behind a given one that is as good
        for (const auto& point : points) {
            if (point.planned != planned) continue;
            data.add({point.soc_percent, point.utility}, {point.mission, planned ? "planned" : "given"});
        }
    }
    const VegaJson kinds{{"domain", {"planned", "given"}}};
    auto shapes = kinds;
    shapes["range"] = {"diamond", "circle"};
    auto sizes = kinds;
    sizes["range"] = {190, 60};
    auto encoding = utility_axes();
    encoding["color"] = category("kind", "", {{"scale", kinds}});
    encoding["shape"] = category("kind", "", {{"scale", shapes}});
    encoding["size"] = {{"field", "kind"}, {"type", "ordinal"}, {"title", ""}, {"scale", sizes}};
    encoding["tooltip"] = {category("mission", "mission"), category("kind", "schedule"),
                           quantity("utility", "utility", {{"format", ".4g"}}),
                           quantity("soc_percent", final_soc_title, {{"format", ".2f"}})};
    return {{"data", data.json()},
            {"mark", {{"type", "point"}, {"filled", true}, {"opacity", 1}}},
            {"encoding", encoding}};
}

/// Points that a reader cannot tell apart share a name.
std::vector<UtilityPoint> named_together(const std::vector<UtilityPoint>& points) {
    constexpr double near_part = 0.02;  // of what the points span
    const auto span_of = [&](double UtilityPoint::*value) {
        const auto [low, high] = std::minmax_element(
            points.begin(), points.end(),
            [&](const UtilityPoint& a, const UtilityPoint& b) { return a.*value < b.*value; });
        return (*high).*value - (*low).*value;
    };
    const double soc_span = span_of(&UtilityPoint::soc_percent);
    const double utility_span = span_of(&UtilityPoint::utility);
    std::vector<UtilityPoint> together;
    for (const auto& point : points) {
        const auto twin = std::find_if(together.begin(), together.end(), [&](const UtilityPoint& other) {
            return std::abs(other.soc_percent - point.soc_percent) <= near_part * soc_span &&
                   std::abs(other.utility - point.utility) <= near_part * utility_span;
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
    double greatest_percent = 0.0;
    for (const auto& point : points) greatest_percent = std::max(greatest_percent, point.soc_percent);
    for (const auto& point : named_together(points)) {
        data.add({point.soc_percent, point.utility},
                 {point.mission, point.soc_percent > right_end * greatest_percent ? "left" : "right"});
    }
    const auto texts = [&](const std::string& side, int away_px) -> VegaJson {
        const bool to_the_left = side == "left";
        auto encoding = utility_axes();
        encoding["text"] = category("mission", "mission");
        return {{"transform", VegaJson::array({{{"filter", {{"field", "side"}, {"equal", side}}}}})},
                {"mark",
                 {{"type", "text"},
                  {"style", "note"},
                  {"align", to_the_left ? "right" : "left"},
                  {"dx", to_the_left ? -away_px : away_px},
                  {"dy", 11},
                  {"limit", 220}}},
                {"encoding", encoding}};
    };
    constexpr int away_px = 8;
    return {{"data", data.json()}, {"layer", {texts("left", away_px), texts("right", away_px)}}};
}

/// A line across with its name.
VegaJson rule_layer(std::string_view channel, double value, const std::string& text) {
    const VegaJson one{{"values", VegaJson::array({{{"text", text}}})}};
    const bool upright = channel == "x";
    const VegaJson rule{
        {"mark", {{"type", "rule"}, {"style", "edge"}, {"strokeDash", {5, 3}}, {"strokeWidth", 1.5}}},
        {"encoding", {{channel, {{"datum", value}}}, {"tooltip", category("text", "line")}}}};
    VegaJson mark{{"type", "text"},
                  {"style", "note"},
                  {"align", upright ? "left" : "right"},
                  {"dx", upright ? 4 : -4},
                  {"dy", upright ? 10 : -5}};
    mark[upright ? "y" : "x"] = upright ? VegaJson(0) : VegaJson{{"expr", "width"}};
    const VegaJson name{{"mark", mark},
                        {"encoding", {{channel, {{"datum", value}}}, {"text", category("text", "line")}}}};
    return {{"data", one}, {"layer", {rule, name}}};
}

VegaJson bars_layer(const mission::Mission& mission, double duration_s) {
    FigureData data({"from_s", "to_s", "middle_s", "power_w", "long_s"}, {"component", "runs"});
    for (const auto& running : running_times(mission)) {
        const auto& component = mission.compute.components[running.component];
        data.add({running.start_s, running.end_s, std::midpoint(running.start_s, running.end_s),
                  power_w(component.profile, running.qos), running.end_s - running.start_s},
                 {component.name, describe_qos(component, running.qos)});
    }
    const VegaJson axis{{"scale", {{"domain", {0.0, duration_s}}, {"nice", false}}},
                        {"axis", {{"grid", false}}}};
    const auto y = category("component", "", {{"sort", nullptr}, {"axis", {{"labelLimit", 130}}}});
    const VegaJson bar{{"mark", {{"type", "bar"}, {"clip", true}, {"height", 15}, {"yOffset", 9}}},
                       {"encoding",
                        {{"x", quantity("from_s", mission_time_title, axis)},
                         {"x2", {{"field", "to_s"}}},
                         {"y", y},
                         {"color", quantity("power_w", "power of the component [W]",
                                            {{"scale", {{"range", "ramp"}}},
                                             {"legend", {{"orient", "bottom"}, {"gradientLength", 160}}}})},
                         {"tooltip",
                          {category("component", "component"), category("runs", "runs"),
                           quantity("from_s", "from [s]", {{"format", ".0f"}}),
                           quantity("to_s", "to [s]", {{"format", ".0f"}}),
                           quantity("power_w", "power [W]", {{"format", ".2f"}})}}}}};
    constexpr double least_part = 0.13;  // of the time: a shorter bar has no room for its words
    const VegaJson words{
        {"transform",
         VegaJson::array({{{"filter", fmt::format("datum.long_s > {}", least_part * duration_s)}}})},
        {"mark", {{"type", "text"}, {"style", "note"}, {"dy", -8}}},
        {"encoding",
         {{"x", quantity("middle_s", mission_time_title, axis)},
          {"y", y},
          {"text", category("runs", "runs")}}}};
    return {{"data", data.json()}, {"layer", {bar, words}}};
}

VegaJson edge_layer(const mission::Mission& mission) {
    FigureData data({"begin_s", "middle_s"}, {"phase"});
    const auto timeline = mission::timeline_of(mission.duration_s);
    for (const auto phase : flight::all_phases) {
        if (mission.duration_s[phase] <= 0.0) continue;
        data.add({timeline.start_s[phase], timeline.start_s[phase] + mission.duration_s[phase] / 2.0},
                 {phase_word(phase)});
    }
    const auto x = quantity("begin_s", mission_time_title);
    const VegaJson rule{
        {"mark", {{"type", "rule"}, {"style", "edge"}, {"strokeDash", {3, 3}}, {"aria", false}}},
        {"encoding", {{"x", x}}}};
    const VegaJson word{
        {"mark", {{"type", "text"}, {"style", "note"}, {"baseline", "bottom"}, {"dy", -3}, {"y", 0}}},
        {"encoding",
         {{"x", quantity("middle_s", mission_time_title)}, {"text", category("phase", "phase")}}}};
    return {{"data", data.json()}, {"layer", {rule, word}}};
}

}  // namespace

std::vector<Running> running_times(const mission::Mission& mission) {
    const auto timeline = mission::timeline_of(mission.duration_s);
    std::vector<Running> times;
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
    return qos.empty() ? "on" : compute::spell_qos(component.profile.parameters, qos, " ", ", ");
}

Figure utility_figure(const SimulatedMission& planned, const std::vector<UtilityPoint>& points,
                      const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.caption =
        "The utility of the schedules, by that of the planned mission, over what they leave. To the left "
        "of the reserve a schedule spends what was to be kept; above the bound there is none that keeps it. "
        "What runs after the battery's end counts nothing.";
    figure.description = "Utility over final state of charge.";
    for (const auto& point : points) {
        figure.description +=
            fmt::format(" {}: {:.4g} at {:.2f} %.", point.mission, point.utility, point.soc_percent);
    }
    figure.spec = new_spec(figure);
    figure.spec["width"] = plan_width;
    figure.spec["height"] = 260;
    figure.spec["layer"] = VegaJson::array();
    const double reserve_percent = planned.simulation.summary.reserve_soc_percent;
    figure.spec["layer"].push_back(rule_layer("x", reserve_percent, "reserve"));
    if (planned.planned->feasible) {
        figure.spec["layer"].push_back(rule_layer("y", planned.planned->bound, "proven bound"));
    }
    figure.spec["layer"].push_back(points_layer(points));
    figure.spec["layer"].push_back(names_layer(points));
    return figure;
}

Figure strip_figure(const SimulatedMission& planned, const std::string& id) {
    const auto& mission = planned.mission;
    Figure figure;
    figure.id = id;
    figure.caption = "What runs when, coloured by its power; a component without a bar is off.";
    figure.description = fmt::format("What {} runs when.", planned.title);
    for (const auto& running : running_times(mission)) {
        const auto& component = mission.compute.components[running.component];
        figure.description +=
            fmt::format(" {} {} from {:.0f} to {:.0f} s.", component.name,
                        describe_qos(component, running.qos), running.start_s, running.end_s);
    }
    figure.spec = new_spec(figure);
    figure.spec["width"] = plan_width;
    figure.spec["height"] = {{"step", 42}};
    figure.spec["usermeta"] = {{"margin_px", 150}};  // the components' names
    figure.spec["layer"] = {bars_layer(mission, mission::timeline_of(mission.duration_s).duration_s),
                            edge_layer(mission)};
    return figure;
}

}  // namespace flightwatt::report
