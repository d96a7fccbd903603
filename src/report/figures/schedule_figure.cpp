#include "report/figures/schedule_figure.h"

#include "report/sections/phase_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr int schedule_width = 640;
constexpr auto schedule_time_title = "time since lift-off [s]";
constexpr auto schedule_soc_title = "state of charge [%]";

FigureData curve_rows(std::span<const SimulatedMission> missions) {
    FigureData data({"time_s", "soc_percent", "power_w", "mission_number"}, {"phase"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        for (const auto& row : missions[m].simulation.curve.rows) {
            data.add({row.time_s, row.soc_percent, row.power_w, static_cast<double>(m)},
                     {phase_word(row.phase)});
        }
    }
    return data;
}

/// The missions' titles, once: rows of curves have only their numbers.
FigureData title_rows(std::span<const SimulatedMission> missions) {
    FigureData data({"mission_number"}, {"mission"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        data.add({static_cast<double>(m)}, {missions[m].title});
    }
    return data;
}

VegaJson with_titles(const FigureData& titles) {
    return VegaJson::array(
        {{{"lookup", "mission_number"},
          {"from",
           {{"data", titles.reference("missions")}, {"key", "mission_number"}, {"fields", {"mission"}}}}},
         shown_by_legend()});
}

VegaJson title_list(std::span<const SimulatedMission> missions) {
    VegaJson titles = VegaJson::array();
    for (const auto& mission : missions) titles.push_back(mission.title);
    return titles;
}

VegaJson color_of(std::span<const SimulatedMission> missions) {
    const VegaJson legend{{"columns", 3}, {"symbolType", "stroke"}};
    return category(
        "mission", "",
        {{"scale", {{"domain", title_list(missions)}, {"range", "category"}}}, {"legend", legend}});
}

/// Dashes tell apart what colours may not: of missions that share a colour, and in print.
VegaJson dash_of(std::span<const SimulatedMission> missions) {
    const std::array<VegaJson, 5> patterns{VegaJson::array({1, 0}), VegaJson::array({7, 3}),
                                           VegaJson::array({2, 2}), VegaJson::array({9, 2, 2, 2}),
                                           VegaJson::array({4, 1})};
    VegaJson range = VegaJson::array();
    for (std::size_t m = 0; m < missions.size(); ++m) range.push_back(patterns[m % patterns.size()]);
    const VegaJson legend{{"columns", 3}, {"symbolType", "stroke"}};
    return category("mission", "",
                    {{"scale", {{"domain", title_list(missions)}, {"range", range}}}, {"legend", legend}});
}

VegaJson curve_layer(std::span<const SimulatedMission> missions, const FigureData& titles) {
    return {{"name", "curves"},
            {"data", curve_rows(missions).json()},
            {"transform", with_titles(titles)},
            {"mark",
             {{"type", "line"},
              {"strokeWidth", 1.8},
              {"clip", true},
              {"point", {{"opacity", 0}, {"size", 50}, {"aria", false}}}}},
            {"encoding",
             {{"x", quantity("time_s", schedule_time_title)},
              {"y", quantity("soc_percent", schedule_soc_title)},
              {"color", color_of(missions)},
              {"strokeDash", dash_of(missions)},
              {"tooltip",
               {category("mission", "mission"), category("phase", "phase"),
                quantity("time_s", "time [s]", {{"format", ".0f"}}),
                quantity("soc_percent", "state of charge [%]", {{"format", ".2f"}}),
                quantity("power_w", "power [W]", {{"format", ".2f"}})}}}}};
}

VegaJson published_layer(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                         const FigureData& titles) {
    FigureData data({"time_s", "soc_percent", "mission_number"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        const auto found = published.soc.find(missions[m].mission.name);
        if (found == published.soc.end()) continue;
        for (std::size_t i = 0; i < found->second.time_s.size(); ++i) {
            data.add({found->second.time_s[i], found->second.value[i], static_cast<double>(m)});
        }
    }
    if (data.empty()) return nullptr;
    return {{"data", data.json()},
            {"transform", with_titles(titles)},
            {"mark", {{"type", "point"}, {"size", 12}, {"strokeWidth", 1}, {"clip", true}, {"aria", false}}},
            {"encoding",
             {{"x", quantity("time_s", schedule_time_title)},
              {"y", quantity("soc_percent", schedule_soc_title)},
              {"color", color_of(missions)},
              {"tooltip",
               {category("mission", "published, Fig. 3"), quantity("time_s", "time [s]", {{"format", ".0f"}}),
                quantity("soc_percent", "state of charge [%]", {{"format", ".2f"}})}}}}};
}

VegaJson phase_layers(std::span<const SimulatedMission> missions) {
    const auto& durations_s = missions.front().mission.duration_s.values;
    const bool all_alike = std::all_of(missions.begin(), missions.end(), [&](const auto& other) {
        return other.mission.duration_s.values == durations_s;
    });
    if (!all_alike) return VegaJson::array();
    FigureData data({"start_s", "end_s", "middle_s"}, {"word"});
    const auto timeline = mission::timeline_of(missions.front().mission.duration_s);
    for (const auto phase : flight::all_phases) {
        const double start_s = timeline.start_s[phase];
        const double end_s = timeline.end_s[phase];
        data.add({start_s, end_s, std::midpoint(start_s, end_s)}, {phase_word(phase)});
    }
    const VegaJson edge{
        {"data", data.json()},
        {"mark",
         {{"type", "rule"}, {"style", "edge"}, {"strokeDash", {3, 3}}, {"clip", true}, {"aria", false}}},
        {"encoding", {{"x", quantity("end_s", schedule_time_title)}}}};
    const VegaJson word{
        {"data", data.json()},
        {"mark",
         {{"type", "text"},
          {"style", "note"},
          {"baseline", "bottom"},
          {"dy", -3},
          {"y", 0},
          {"clip", false}}},
        {"encoding",
         {{"x", quantity("middle_s", schedule_time_title)}, {"text", category("word", "phase")}}}};
    return VegaJson::array({edge, word});
}

/// A bar a segment: when a mission runs which configuration.
VegaJson strip_panel(std::span<const SimulatedMission> missions, double longest_s) {
    FigureData data({"start_s", "end_s", "compute_w"}, {"mission", "phase", "runs"});
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        const auto timeline = mission::timeline_of(mission.duration_s);
        for (const auto& segment : mission.schedule) {
            const double start_s = timeline.start_s[segment.phase];
            data.add(
                {start_s + segment.start_s, start_s + segment.end_s, power_w(mission.compute, segment.run)},
                {simulated.title, phase_word(segment.phase), describe(mission.compute, segment.run)});
        }
    }
    const VegaJson axis{{"scale", {{"domain", {0.0, longest_s}}, {"nice", false}}},
                        {"axis", {{"grid", false}}}};
    return {{"width", schedule_width},
            {"height", {{"step", 18}}},
            {"data", data.json()},
            {"mark", {{"type", "bar"}, {"clip", true}}},
            {"encoding",
             {{"x", quantity("start_s", schedule_time_title, axis)},
              {"x2", {{"field", "end_s"}}},
              {"y", category("mission", "",
                             {{"sort", title_list(missions)},
                              {"axis", {{"labelLimit", 150}, {"ticks", false}, {"domain", false}}}})},
              {"color", quantity("compute_w", "computing power [W]",
                                 {{"scale", {{"range", "ramp"}}},
                                  {"legend", {{"orient", "bottom"}, {"gradientLength", 160}}}})},
              {"tooltip",
               {category("mission", "mission"), category("phase", "phase"), category("runs", "runs"),
                quantity("start_s", "from [s]", {{"format", ".0f"}}),
                quantity("end_s", "to [s]", {{"format", ".0f"}}),
                quantity("compute_w", "computing power [W]", {{"format", ".2f"}})}}}}};
}

std::string described(std::span<const SimulatedMission> missions) {
    std::string text = "State of charge over the mission.";
    for (const auto& mission : missions) {
        text += fmt::format(" {}.", describe(mission.simulation.summary));
    }
    return text;
}

}  // namespace

Figure schedule_figure(std::span<const SimulatedMission> missions, const PublishedFigures& published,
                       const std::string& id) {
    Figure figure{id,
                  "A click on the legend hides a mission. Below: what each schedule runs when, coloured by "
                  "its power.",
                  described(missions),
                  "zoom_time_s",
                  "x",
                  {}};
    double longest_s = 0.0;
    for (const auto& mission : missions)
        longest_s = std::max(longest_s, mission.simulation.summary.duration_s);
    const auto titles = title_rows(missions);
    auto layers = phase_layers(missions);
    layers.push_back(curve_layer(missions, titles));
    if (auto points = published_layer(missions, published, titles); !points.is_null()) {
        layers.push_back(std::move(points));
        figure.caption += " Points: the paper's Fig. 3, digitised.";
    }
    for (auto& layer : layers) {
        layer["encoding"]["x"]["scale"] = {{"domain", {0.0, longest_s}}, {"nice", false}};
        if (layer["encoding"].contains("y")) {
            layer["encoding"]["y"]["scale"] = {{"domain", {0.0, 100.0}}};
        }
    }
    auto zoom = zoom_parameter("x");
    zoom["views"] = {"curves"};
    figure.spec = new_spec(figure);
    figure.spec["params"] = {zoom, legend_parameter("mission", title_list(missions), "curves")};
    figure.spec["usermeta"] = {{"margin_px", 170}};  // the strip's names
    figure.spec["datasets"] = {{"missions", titles.csv()}};
    figure.spec["vconcat"] = {{{"width", schedule_width}, {"height", 330}, {"layer", layers}},
                              strip_panel(missions, longest_s)};
    figure.spec["resolve"] = {
        {"scale", {{"x", "shared"}, {"color", "independent"}, {"strokeDash", "independent"}}}};
    return figure;
}

}  // namespace flightwatt::report
