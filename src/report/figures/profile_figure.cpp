#include "base/statistics.h"
#include "base/utf8.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// Every node's QoS: the last parameter runs fastest, as in PowerProfile.
std::vector<double> qos_of_node(const compute::PowerProfile& profile, std::size_t node) {
    std::vector<double> qos(profile.axes.size());
    for (std::size_t p = profile.axes.size(); p-- > 0;) {
        qos[p] = profile.axes[p][node % profile.axes[p].size()];
        node /= profile.axes[p].size();
    }
    return qos;
}

/// The line that a node belongs to: its parameters but the first.
std::string line_name(const compute::PowerProfile& profile, const std::vector<double>& qos) {
    std::vector<std::string> parts;
    for (std::size_t p = 1; p < qos.size(); ++p) {
        parts.push_back(fmt::format("{} {:g}", profile.parameters[p], qos[p]));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

bool is_measured(const compute::PowerProfile& profile, std::size_t node) {
    return profile.is_measured.empty() || profile.is_measured[node];
}

bool all_measured(const compute::PowerProfile& profile) {
    return std::ranges::all_of(profile.is_measured, [](bool measured) { return measured; });
}

/// The nodes: interpolated ones are hollow where there are any.
VegaJson points_layer(const compute::PowerProfile& profile) {
    auto points = layer(R"({"type": "point", "style": "measured", "size": 45, "opacity": 1})", VegaJson::object());
    if (all_measured(profile)) {
        points["mark"]["filled"] = true;
    } else {
        points["encoding"]["shape"] = nominal_channel("origin", "", vega(R"({"scale":
            {"domain": ["measured", "interpolated"], "range": ["circle", "cross"]}})"));
    }
    return points;
}

FigureData node_rows(const compute::PowerProfile& profile) {
    FigureData data({"qos", "power_w", "error_w", "low_w", "high_w"}, {"line", "origin"});
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = qos_of_node(profile, node);
        const double power_w = profile.power_w[node];
        const double error_w = profile.standard_error_w.empty() ? std::nan("") : profile.standard_error_w[node];
        const double reach_w = normal_half_width() * error_w;
        data.add({qos.empty() ? 0.0 : qos.front(), power_w, error_w, power_w - reach_w, power_w + reach_w},
                 {line_name(profile, qos), is_measured(profile, node) ? "measured" : "interpolated"});
    }
    return data;
}

VegaJson panel_of(const compute::Component& component) {
    const auto& profile = component.profile;
    const auto title = profile.parameters.empty() ? "no parameter" : valid_utf8(profile.parameters.front());
    VegaJson encoding{{"x", numeric_channel("qos", title, {{"scale", {{"zero", false}}}})},
                      {"y", numeric_channel("power_w", "power [W]")},
                      {"tooltip", {numeric_channel("qos", title), tooltip_number("power_w", "power [W]", ".2f")}}};
    if (profile.parameters.size() > 1) {
        encoding["color"] = nominal_channel("line", "", {{"sort", nullptr}});
        encoding["tooltip"].push_back(nominal_channel("line", "also"));
    }
    auto layers = vega(R"([{"mark": {"type": "line", "style": "measured"}}])");
    if (!profile.standard_error_w.empty()) {
        encoding["tooltip"].push_back(tooltip_number("error_w", "standard error [W]", ".3f"));
        layers.push_back(layer(R"({"type": "rule", "style": "measured", "strokeWidth": 1.4})",
                               {{"y", numeric_channel("low_w", "power [W]")}, {"y2", {{"field", "high_w"}}}}));
    }
    if (!all_measured(profile)) encoding["tooltip"].push_back(nominal_channel("origin", "node"));
    layers.push_back(points_layer(profile));
    const VegaJson nodes{{"data", node_rows(profile).json()}, {"encoding", encoding}, {"layer", layers}};
    return {{"width", 280}, {"height", 190}, {"layer", {nodes, panel_name(component.name)}}};
}

std::string profile_described(const compute::ComputeModel& compute) {
    std::string text = "Profiled power of the software on board.";
    for (const auto& [name, profile] : compute.components) {
        const auto [least, greatest] = std::ranges::minmax_element(profile.power_w);
        text += fmt::format(" {}: {:.2f} to {:.2f} W in {} configurations.", name, *least, *greatest,
                            profile.power_w.size());
    }
    return text;
}

std::string profile_caption(const compute::ComputeModel& compute) {
    const auto any = [&](const auto& holds) {
        return std::ranges::any_of(compute.components,
                                   [&](const compute::Component& component) { return holds(component.profile); });
    };
    const bool interpolated = any([](const auto& profile) { return !all_measured(profile); });
    std::string text = interpolated ? "Circles were measured, crosses found between them;" : "Points were profiled,";
    text += " lines are interpolated between them, and nothing is extrapolated.";
    if (any([](const auto& profile) { return !profile.standard_error_w.empty(); })) {
        text += " Bars are 95 % intervals, of the standard errors that the profile has.";
    }
    if (any([](const auto& profile) { return profile.standard_error_w.empty(); })) {
        text += " A component without bars has a profile without standard errors.";
    }
    return text +
           " The powers of the components that run add up; a component that runs on top of another is "
           "profiled as what it adds.";
}

}  // namespace

Figure profile_figure(const compute::ComputeModel& compute, const std::string& id) {
    auto figure = new_figure(id, profile_caption(compute), profile_described(compute));
    auto panels = VegaJson::array();
    for (const auto& component : compute.components) panels.push_back(panel_of(component));
    set_panels(figure, 2, 72, panels);
    figure.spec["resolve"] = vega(R"({"scale": {"color": "independent"}})");
    return figure;
}

}  // namespace flightwatt::report
