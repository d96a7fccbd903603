#include "report/figures/profile_figure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

constexpr double wide_95 = 1.96;

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
    return std::all_of(profile.is_measured.begin(), profile.is_measured.end(),
                       [](bool measured) { return measured; });
}

/// The nodes: interpolated ones are hollow where there are any.
VegaJson points_layer(const compute::PowerProfile& profile) {
    VegaJson layer{{"mark", {{"type", "point"}, {"style", "measured"}, {"size", 45}, {"opacity", 1}}},
                   {"encoding", VegaJson::object()}};
    if (all_measured(profile)) {
        layer["mark"]["filled"] = true;
        return layer;
    }
    const VegaJson shapes{{"domain", {"measured", "interpolated"}}, {"range", {"circle", "cross"}}};
    layer["encoding"]["shape"] = category("origin", "", {{"scale", shapes}});
    return layer;
}

VegaJson panel_of(const compute::Component& component) {
    const auto& profile = component.profile;
    FigureData data({"qos", "power_w", "error_w", "low_w", "high_w"}, {"line", "origin"});
    const auto& errors_w = profile.standard_error_w;
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = qos_of_node(profile, node);
        const double power_w = profile.power_w[node];
        const double error_w = errors_w.empty() ? std::nan("") : errors_w[node];
        data.add({qos.empty() ? 0.0 : qos.front(), power_w, error_w, power_w - wide_95 * error_w,
                  power_w + wide_95 * error_w},
                 {line_name(profile, qos), is_measured(profile, node) ? "measured" : "interpolated"});
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
    VegaJson layers = VegaJson::array({{{"mark", {{"type", "line"}, {"style", "measured"}}}}});
    if (!errors_w.empty()) {
        encoding["tooltip"].push_back(quantity("error_w", "standard error [W]", {{"format", ".3f"}}));
        layers.push_back(
            {{"mark", {{"type", "rule"}, {"style", "measured"}, {"strokeWidth", 1.4}}},
             {"encoding", {{"y", quantity("low_w", "power [W]")}, {"y2", {{"field", "high_w"}}}}}});
    }
    if (!all_measured(profile)) encoding["tooltip"].push_back(category("origin", "node"));
    layers.push_back(points_layer(profile));
    return {{"title", valid_utf8(component.name)},
            {"width", 280},
            {"height", 190},
            {"data", data.json()},
            {"encoding", encoding},
            {"layer", layers}};
}

std::string described(const compute::ComputeModel& compute) {
    std::string text = "Profiled power of the software on board.";
    for (const auto& [name, profile] : compute.components) {
        const auto [least, greatest] = std::minmax_element(profile.power_w.begin(), profile.power_w.end());
        text += fmt::format(" {}: {:.2f} to {:.2f} W in {} configurations.", name, *least, *greatest,
                            profile.power_w.size());
    }
    return text;
}

std::string caption_of(const compute::ComputeModel& compute) {
    const auto any = [&](const auto& holds) {
        return std::any_of(compute.components.begin(), compute.components.end(),
                           [&](const compute::Component& component) { return holds(component.profile); });
    };
    const bool interpolated = any([](const auto& profile) { return !all_measured(profile); });
    std::string text =
        interpolated ? "Circles were measured, crosses found between them;" : "Points were profiled,";
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
    Figure figure;
    figure.id = id;
    figure.caption = caption_of(compute);
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

}  // namespace flightwatt::report
