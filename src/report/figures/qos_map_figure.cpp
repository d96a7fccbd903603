#include "report/figures/qos_map_figure.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr auto map_soc_title = "final state of charge [%]";

double cell_soc(const QosMap& map, std::size_t i, std::size_t j) {
    return (map.at(i, j) + map.at(i + 1, j) + map.at(i, j + 1) + map.at(i + 1, j + 1)) / 4.0;
}

VegaJson axis(const std::string& field, const QosAxis& qos) {
    return quantity(
        field, valid_utf8(qos.name),
        {{"scale", {{"domain", {qos.nodes.front(), qos.nodes.back()}}, {"nice", false}, {"zero", false}}},
         {"axis", {{"grid", false}}}});
}

VegaJson color(const std::string& field) {
    return quantity(field, map_soc_title,
                    {{"scale", {{"range", "heatmap"}}}, {"legend", {{"gradientLength", 200}}}});
}

VegaJson cell_layer(const QosMap& map) {
    FigureData data({"x_low", "x_high", "y_low", "y_high", "soc_percent"});
    for (std::size_t j = 0; j + 1 < map.y.nodes.size(); ++j) {
        for (std::size_t i = 0; i + 1 < map.x.nodes.size(); ++i) {
            data.add({map.x.nodes[i], map.x.nodes[i + 1], map.y.nodes[j], map.y.nodes[j + 1],
                      cell_soc(map, i, j)});
        }
    }
    return {{"data", data.json()},
            {"mark", {{"type", "rect"}}},
            {"encoding",
             {{"x", axis("x_low", map.x)},
              {"x2", {{"field", "x_high"}}},
              {"y", axis("y_low", map.y)},
              {"y2", {{"field", "y_high"}}},
              {"color", color("soc_percent")},
              {"tooltip",
               {quantity("x_low", valid_utf8(map.x.name) + " from"), quantity("x_high", "to"),
                quantity("y_low", valid_utf8(map.y.name) + " from"), quantity("y_high", "to"),
                quantity("soc_percent", map_soc_title, {{"format", ".2f"}})}}}}};
}

/// The configurations that the missions run with both components on, and who runs them.
std::map<std::pair<double, double>, std::string> configurations(const QosMap& map,
                                                                std::span<const SimulatedMission> missions) {
    std::map<std::pair<double, double>, std::string> marked;
    for (const auto& mission : missions) {
        for (const auto& segment : mission.mission.schedule) {
            std::optional<double> x;
            std::optional<double> y;
            for (const auto& running : segment.run) {
                if (running.component == map.x.component) x = running.qos[map.x.parameter];
                if (running.component == map.y.component) y = running.qos[map.y.parameter];
            }
            if (!x || !y) continue;
            auto& who = marked[{*x, *y}];
            if (who.ends_with(mission.title)) continue;
            who += (who.empty() ? "" : ", ") + mission.title;
        }
    }
    return marked;
}

VegaJson marker_layer(const QosMap& map, std::span<const SimulatedMission> missions) {
    FigureData data({"x", "y"}, {"missions"});
    for (const auto& [place, who] : configurations(map, missions))
        data.add({place.first, place.second}, {who});
    return {{"data", data.json()},
            {"mark",
             {{"type", "point"},
              {"shape", "diamond"},
              {"style", "marker"},
              {"filled", true},
              {"opacity", 1},
              {"size", 130},
              {"strokeWidth", 1.5}}},
            {"encoding",
             {{"x", axis("x", map.x)},
              {"y", axis("y", map.y)},
              {"tooltip",
               {category("missions", "run by"), quantity("x", valid_utf8(map.x.name)),
                quantity("y", valid_utf8(map.y.name))}}}}};
}

VegaJson published_layer(const QosMap& map, const std::vector<PublishedCell>& cells) {
    FigureData data({"x", "y", "soc_percent"});
    for (const auto& cell : cells) {
        data.add({std::midpoint(cell.fps_low, cell.fps_high),
                  std::midpoint(cell.key_bits_low, cell.key_bits_high), cell.soc_percent});
    }
    return {{"data", data.json()},
            {"mark",
             {{"type", "circle"},
              {"size", 80},
              {"opacity", 1},
              {"stroke", "#ffffff"},
              {"strokeWidth", 0.8},
              {"strokeOpacity", 0.8},
              {"aria", false}}},
            {"encoding",
             {{"x", axis("x", map.x)},
              {"y", axis("y", map.y)},
              {"color", color("soc_percent")},
              {"tooltip",
               {quantity("x", valid_utf8(map.x.name)), quantity("y", valid_utf8(map.y.name)),
                quantity("soc_percent", "published, Fig. 4 [%]", {{"format", ".2f"}})}}}}};
}

/// The least and the greatest of what can be delivered; both 0 if nothing can.
std::pair<double, double> range_of(const QosMap& map) {
    std::vector<double> known;
    std::copy_if(map.soc_percent.begin(), map.soc_percent.end(), std::back_inserter(known),
                 [](double soc) { return std::isfinite(soc); });
    if (known.empty()) return {0.0, 0.0};
    const auto [least, greatest] = std::minmax_element(known.begin(), known.end());
    return {*least, *greatest};
}

/// Of the published cells that are cells of the map; std::nullopt if one is not.
std::optional<double> rms_to_published(const QosMap& map, const std::vector<PublishedCell>& cells) {
    const auto index = [](const std::vector<double>& nodes, double low) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
            if (std::abs(nodes[i] - low) < 0.02 * (nodes.back() - nodes.front())) return i;
        }
        return std::nullopt;
    };
    double squares = 0.0;
    for (const auto& cell : cells) {
        const auto i = index(map.x.nodes, cell.fps_low);
        const auto j = index(map.y.nodes, cell.key_bits_low);
        if (!i || !j) return std::nullopt;
        squares += std::pow(cell_soc(map, *i, *j) - cell.soc_percent, 2);
    }
    if (cells.empty()) return std::nullopt;
    return std::sqrt(squares / static_cast<double>(cells.size()));
}

}  // namespace

Figure qos_map_figure(const QosMap& map, std::span<const SimulatedMission> missions,
                      const std::vector<PublishedCell>& published, const std::string& id) {
    Figure figure;
    figure.id = id;
    const auto [least, greatest] = range_of(map);
    figure.description = fmt::format(
        "Final state of charge over {} and {}: from {:.1f} % to {:.1f} % where one configuration runs "
        "throughout.",
        map.x.name, map.y.name, least, greatest);
    figure.caption =
        "State of charge at the end if one configuration ran throughout. A cell is the mean of its corners; "
        "diamonds are the configurations that the missions run.";
    if (!map.others.empty()) figure.caption += fmt::format(" With {}.", map.others);
    const auto rms = rms_to_published(map, published);
    if (rms) {
        figure.caption += fmt::format(
            " Discs: the paper's Fig. 4, digitised, on the same colours: one that agrees is seen by its rim "
            "alone. RMS "
            "difference over {} cells {:.2f} points.",
            published.size(), *rms);
    }
    figure.spec = new_spec(figure);
    figure.spec["width"] = 560;
    figure.spec["height"] = 320;
    figure.spec["layer"] = VegaJson::array({cell_layer(map)});
    if (rms) figure.spec["layer"].push_back(published_layer(map, published));
    figure.spec["layer"].push_back(marker_layer(map, missions));
    return figure;
}

}  // namespace flightwatt::report
