#include "report/profile_figure.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// Every node's QoS: the last parameter runs fastest, as in PowerProfile.
std::vector<double> qos_of_node(const PowerProfile& profile, std::size_t node) {
    std::vector<double> qos(profile.axes.size());
    for (std::size_t p = profile.axes.size(); p-- > 0;) {
        qos[p] = profile.axes[p][node % profile.axes[p].size()];
        node /= profile.axes[p].size();
    }
    return qos;
}

/// The line that a node belongs to: its parameters but the first.
std::string line_name(const PowerProfile& profile, const std::vector<double>& qos) {
    std::vector<std::string> parts;
    for (std::size_t p = 1; p < qos.size(); ++p) {
        parts.push_back(fmt::format("{} {:g}", profile.parameters[p], qos[p]));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

VegaJson panel_of(const Component& component) {
    const auto& profile = component.profile;
    FigureData data({"qos", "power_w"}, {"line"});
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = qos_of_node(profile, node);
        data.add({qos.empty() ? 0.0 : qos.front(), profile.power_w[node]}, {line_name(profile, qos)});
    }
    const auto title = profile.parameters.empty() ? "no parameter" : valid_utf8(profile.parameters.front());
    VegaJson encoding{
        {"x", quantity("qos", title, {{"scale", {{"zero", false}}}})},
        {"y", quantity("power_w", "power [W]")},
        {"tooltip", {quantity("qos", title), quantity("power_w", "power [W]", {{"format", ".2f"}})}}};
    if (profile.parameters.size() > 1) {
        encoding["color"] = category("line", "", {{"sort", nullptr}});
        encoding["tooltip"].push_back(category("line", "also"));
    }
    return {{"title", valid_utf8(component.name)},
            {"width", 280},
            {"height", 190},
            {"data", data.json()},
            {"mark", {{"type", "line"}, {"style", "measured"}, {"point", {{"size", 45}, {"filled", true}}}}},
            {"encoding", encoding}};
}

std::string described(const ComputeModel& compute) {
    std::string text = "Profiled power of the software on board.";
    for (const auto& [name, profile] : compute.components) {
        const auto [least, greatest] = std::minmax_element(profile.power_w.begin(), profile.power_w.end());
        text += fmt::format(" {}: {:.2f} to {:.2f} W in {} configurations.", name, *least, *greatest,
                            profile.power_w.size());
    }
    return text;
}

}  // namespace

Figure profile_figure(const ComputeModel& compute, const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.caption =
        "Points were profiled, lines are interpolated between them, and nothing is extrapolated. The powers "
        "of the components that run add up; a component that runs on top of another is profiled as what it "
        "adds.";
    figure.description = described(compute);
    figure.spec = new_spec(figure);
    figure.spec["columns"] = 2;
    figure.spec["bounds"] = "flush";
    figure.spec["spacing"] = {{"column", 62}, {"row", 72}};
    figure.spec["concat"] = VegaJson::array();
    for (const auto& component : compute.components) figure.spec["concat"].push_back(panel_of(component));
    figure.spec["resolve"] = {{"scale", {{"color", "independent"}}}};
    return figure;
}

}  // namespace flightwatt
