#include "report/figures/mission_figures.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

constexpr int schedule_width = 640;
constexpr auto schedule_time_title = "time since lift-off [s]";
constexpr auto schedule_soc_title = "state of charge [%]";

FigureData curve_rows(Missions missions) {
    FigureData data({"time_s", "soc_percent", "power_w", "mission_number"}, {"phase"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        for (const auto& row : missions[m].simulation.curve.rows) {
            data.add({row.time_s, row.soc_percent, row.power_w, static_cast<double>(m)}, {phase_word(row.phase)});
        }
    }
    return data;
}

/// The missions' titles, once: rows of curves have only their numbers.
FigureData title_rows(Missions missions) {
    FigureData data({"mission_number"}, {"mission"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        data.add({static_cast<double>(m)}, {missions[m].title});
    }
    return data;
}

VegaJson with_titles(const FigureData& titles) {
    return VegaJson::array(
        {{{"lookup", "mission_number"},
          {"from", {{"data", titles.reference("missions")}, {"key", "mission_number"}, {"fields", {"mission"}}}}},
         shown_by_legend()});
}

VegaJson title_list(Missions missions) {
    auto titles = VegaJson::array();
    for (const auto& mission : missions) titles.push_back(mission.title);
    return titles;
}

/// The channel that tells missions apart by a range of colours or dashes.
VegaJson mission_channel(Missions missions, const VegaJson& range) {
    return nominal_channel("mission", "",
                           {{"scale", {{"domain", title_list(missions)}, {"range", range}}},
                            {"legend", {{"columns", 3}, {"symbolType", "stroke"}}}});
}

/// Dashes tell apart what colours may not: of missions that share a colour, and in print.
VegaJson dashes_of(Missions missions) {
    const auto patterns = vega("[[1, 0], [7, 3], [2, 2], [9, 2, 2, 2], [4, 1]]");
    auto range = VegaJson::array();
    for (std::size_t m = 0; m < missions.size(); ++m) range.push_back(patterns[m % patterns.size()]);
    return range;
}

VegaJson curve_layer(Missions missions, const FigureData& titles) {
    return {{"name", "curves"},
            {"data", curve_rows(missions).json()},
            {"transform", with_titles(titles)},
            {"mark", vega(R"({"type": "line", "strokeWidth": 1.8, "clip": true,
                              "point": {"opacity": 0, "size": 50, "aria": false}})")},
            {"encoding",
             {{"x", numeric_channel("time_s", schedule_time_title)},
              {"y", numeric_channel("soc_percent", schedule_soc_title)},
              {"color", mission_channel(missions, "category")},
              {"strokeDash", mission_channel(missions, dashes_of(missions))},
              {"tooltip",
               {nominal_channel("mission", "mission"), nominal_channel("phase", "phase"),
                tooltip_number("time_s", "time [s]", ".0f"), tooltip_number("soc_percent", schedule_soc_title, ".2f"),
                tooltip_number("power_w", "power [W]", ".2f")}}}}};
}

VegaJson published_layer(Missions missions, const PublishedFigures& published, const FigureData& titles) {
    FigureData data({"time_s", "soc_percent", "mission_number"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        const auto found = published.soc.find(missions[m].mission.name);
        if (found == published.soc.end()) continue;
        const auto& [time_s, soc_percent] = found->second;
        for (std::size_t i = 0; i < time_s.size(); ++i) data.add({time_s[i], soc_percent[i], static_cast<double>(m)});
    }
    if (data.empty()) return nullptr;
    return {{"data", data.json()},
            {"transform", with_titles(titles)},
            {"mark", vega(R"({"type": "point", "size": 12, "strokeWidth": 1, "clip": true, "aria": false})")},
            {"encoding",
             {{"x", numeric_channel("time_s", schedule_time_title)},
              {"y", numeric_channel("soc_percent", schedule_soc_title)},
              {"color", mission_channel(missions, "category")},
              {"tooltip",
               {nominal_channel("mission", "published, Fig. 3"), tooltip_number("time_s", "time [s]", ".0f"),
                tooltip_number("soc_percent", schedule_soc_title, ".2f")}}}}};
}

/// Where 5 to 95 % of the flights that were drawn are.
VegaJson band_layer(Missions missions, const FigureData& titles) {
    FigureData data({"time_s", "p05_percent", "p95_percent", "mission_number"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        const auto& samples = missions[m].simulation.summary.samples;
        if (!samples) continue;
        for (const auto& band : samples->bands)
            data.add({band.time_s, band.p05_percent, band.p95_percent, static_cast<double>(m)});
    }
    if (data.empty()) return nullptr;
    auto transform = with_titles(titles);
    transform.push_back({{"filter", {{"param", "shown"}}}});
    return {{"data", data.json()},
            {"transform", transform},
            {"mark", vega(R"({"type": "area", "fillOpacity": 0.16, "clip": true, "aria": false})")},
            {"encoding",
             {{"x", numeric_channel("time_s", schedule_time_title)},
              {"y", numeric_channel("p05_percent", schedule_soc_title)},
              {"y2", {{"field", "p95_percent"}}},
              {"color", mission_channel(missions, "category")}}}};
}

/// The reserves that the missions ask for, each once.
VegaJson reserve_layer(Missions missions) {
    FigureData data({"reserve_percent"});
    std::vector<double> drawn;
    for (const auto& simulated : missions) {
        const double reserve_percent = simulated.simulation.summary.reserve_soc_percent;
        if (reserve_percent <= 0.0 || std::ranges::count(drawn, reserve_percent) > 0) continue;
        drawn.push_back(reserve_percent);
        data.add({reserve_percent});
    }
    if (data.empty()) return nullptr;
    return {{"data", data.json()},
            {"mark", vega(R"({"type": "rule", "style": "edge", "strokeDash": [5, 4], "aria": false})")},
            {"encoding",
             {{"y", numeric_channel("reserve_percent", schedule_soc_title)},
              {"tooltip", {tooltip_number("reserve_percent", "reserve [%]", ".4g")}}}}};
}

VegaJson phase_layers(Missions missions) {
    const auto& durations_s = missions.front().mission.duration_s;
    const bool all_alike = std::ranges::all_of(
        missions, [&](const auto& other) { return other.mission.duration_s.values == durations_s.values; });
    if (!all_alike) return VegaJson::array();
    FigureData data({"start_s", "end_s", "middle_s"}, {"word"});
    const auto timeline = mission::timeline_of(durations_s);
    for (const auto phase : flight::all_phases) {
        const double start_s = timeline.start_s[phase];
        const double end_s = timeline.end_s[phase];
        data.add({start_s, end_s, std::midpoint(start_s, end_s)}, {phase_word(phase)});
    }
    const auto edges =
        layer(data.json(), R"({"type": "rule", "style": "edge", "strokeDash": [3, 3], "clip": true, "aria": false})",
              {{"x", numeric_channel("end_s", schedule_time_title)}});
    return VegaJson::array({edges, phase_names(data.json(), schedule_time_title)});
}

/// A bar a segment: when a mission runs which configuration.
VegaJson strip_panel(Missions missions, double max_s) {
    FigureData data({"start_s", "end_s", "compute_w"}, {"mission", "phase", "runs"});
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        const auto timeline = mission::timeline_of(mission.duration_s);
        for (const auto& segment : mission.schedule) {
            const double start_s = timeline.start_s[segment.phase];
            data.add({start_s + segment.start_s, start_s + segment.end_s, power_w(mission.compute, segment.run)},
                     {simulated.title, phase_word(segment.phase), describe(mission.compute, segment.run)});
        }
    }
    const VegaJson whole{{"scale", {{"domain", {0.0, max_s}}, {"nice", false}}}, {"axis", {{"grid", false}}}};
    const VegaJson rows{{"sort", title_list(missions)},
                        {"axis", {{"labelLimit", 150}, {"ticks", false}, {"domain", false}}}};
    return {
        {"width", schedule_width},
        {"height", {{"step", 18}}},
        {"data", data.json()},
        {"mark", {{"type", "bar"}, {"clip", true}}},
        {"encoding",
         {{"x", numeric_channel("start_s", schedule_time_title, whole)},
          {"x2", {{"field", "end_s"}}},
          {"y", nominal_channel("mission", "", rows)},
          {"color", power_ramp("compute_w", "computing power [W]")},
          {"tooltip",
           {nominal_channel("mission", "mission"), nominal_channel("phase", "phase"), nominal_channel("runs", "runs"),
            tooltip_number("start_s", "from [s]", ".0f"), tooltip_number("end_s", "to [s]", ".0f"),
            tooltip_number("compute_w", "computing power [W]", ".2f")}}}}};
}

std::string schedules_described(Missions missions) {
    std::string text = "State of charge over the mission.";
    for (const auto& mission : missions) {
        text += fmt::format(" {}.", describe(mission.simulation.summary));
    }
    return text;
}

}  // namespace

Figure schedule_figure(Missions missions, const PublishedFigures& published, const std::string& id) {
    auto figure = new_figure(
        id, "A click on the legend hides a mission. Below: what each schedule runs when, coloured by its power.",
        schedules_described(missions));
    double max_s = 0.0;
    for (const auto& mission : missions) max_s = std::max(max_s, mission.simulation.summary.duration_s);
    const auto titles = title_rows(missions);
    auto layers = phase_layers(missions);
    if (auto bands = band_layer(missions, titles); !bands.is_null()) {
        layers.push_back(std::move(bands));
        figure.caption += " Shaded: 5 to 95 % of the flights drawn.";
    }
    if (auto reserves = reserve_layer(missions); !reserves.is_null()) {
        layers.push_back(std::move(reserves));
        figure.caption += " Level dashes: the reserve.";
    }
    layers.push_back(curve_layer(missions, titles));
    if (auto points = published_layer(missions, published, titles); !points.is_null()) {
        layers.push_back(std::move(points));
        figure.caption += " Points: the paper's Fig. 3, digitised.";
    }
    for (auto& part : layers) {
        if (part["encoding"].contains("x"))
            part["encoding"]["x"]["scale"] = {{"domain", {0.0, max_s}}, {"nice", false}};
        if (part["encoding"].contains("y")) part["encoding"]["y"]["scale"] = vega(R"({"domain": [0.0, 100.0]})");
    }
    figure.spec["params"] = {add_zoom(figure, {"curves"}), legend_parameter("mission", title_list(missions), "curves")};
    figure.spec["usermeta"] = {{"margin_px", 170}};  // the strip's names
    figure.spec["datasets"] = {{"missions", titles.csv()}};
    figure.spec["vconcat"] = {{{"width", schedule_width}, {"height", 330}, {"layer", layers}},
                              strip_panel(missions, max_s)};
    figure.spec["resolve"] = vega(R"({"scale": {"x": "shared", "color": "independent", "strokeDash": "independent"}})");
    return figure;
}

}  // namespace flightwatt::report
