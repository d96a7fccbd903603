#include "base/statistics.h"
#include "base/text.h"
#include "mission/schedule.h"
#include "mission/simulation.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// The profiled values, and two more between each of them: the paper's grid.
std::vector<double> with_thirds(const std::vector<double>& profiled) {
    std::vector<double> nodes{profiled.front()};
    for (std::size_t i = 1; i < profiled.size(); ++i) {
        for (int third = 1; third <= 3; ++third) nodes.push_back(std::lerp(profiled[i - 1], profiled[i], third / 3.0));
    }
    return nodes;
}

std::vector<QosAxis> axes_of(const compute::ComputeModel& compute) {
    std::vector<QosAxis> axes;
    for (std::size_t c = 0; c < compute.components.size(); ++c) {
        const auto& [name, profile] = compute.components[c];
        for (std::size_t p = 0; p < profile.parameters.size(); ++p) {
            axes.push_back({c, p, name + " " + profile.parameters[p], with_thirds(profile.axes[p])});
        }
    }
    return axes;
}

/// Everything at its greatest quality.
compute::Configuration greatest(const compute::ComputeModel& compute) {
    compute::Configuration run;
    for (std::size_t c = 0; c < compute.components.size(); ++c) {
        compute::RunningComponent running{c, {}};
        for (const auto& axis : compute.components[c].profile.axes) running.qos.push_back(axis.back());
        run.push_back(std::move(running));
    }
    return run;
}

std::vector<mission::ScheduleSegment> throughout(const mission::MissionSetup& mission,
                                                 const compute::Configuration& run) {
    std::vector<mission::ScheduleSegment> schedule;
    for (const auto phase : flight::all_phases) {
        if (mission.duration_s[phase] > 0.0) schedule.push_back({phase, 0.0, mission.duration_s[phase], run});
    }
    return schedule;
}

double cell_soc(const QosMap& map, std::size_t i, std::size_t j) {
    return (map.at(i, j) + map.at(i + 1, j) + map.at(i, j + 1) + map.at(i + 1, j + 1)) / 4.0;
}

VegaJson cell_rows(const QosMap& map) {
    FigureData data({"x_low", "x_high", "y_low", "y_high", "soc_percent"});
    for (std::size_t j = 0; j + 1 < map.y.nodes.size(); ++j) {
        for (std::size_t i = 0; i + 1 < map.x.nodes.size(); ++i) {
            data.add({map.x.nodes[i], map.x.nodes[i + 1], map.y.nodes[j], map.y.nodes[j + 1], cell_soc(map, i, j)});
        }
    }
    return data.json();
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

VegaJson marker_rows(const QosMap& map, std::span<const SimulatedMission> missions) {
    FigureData data({"x", "y"}, {"missions"});
    for (const auto& [place, who] : configurations(map, missions)) data.add({place.first, place.second}, {who});
    return data.json();
}

VegaJson published_rows(const std::vector<PublishedCell>& cells) {
    FigureData data({"x", "y", "soc_percent"});
    for (const auto& cell : cells) {
        data.add({std::midpoint(cell.fps_low, cell.fps_high), std::midpoint(cell.key_bits_low, cell.key_bits_high),
                  cell.soc_percent});
    }
    return data.json();
}

/// The least and the greatest of what can be delivered; both 0 if nothing can.
std::pair<double, double> range_of(const QosMap& map) {
    std::vector<double> known;
    std::ranges::copy_if(map.soc_percent, std::back_inserter(known), [](double soc) { return std::isfinite(soc); });
    if (known.empty()) return {0.0, 0.0};
    const auto [least, greatest] = std::ranges::minmax_element(known);
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

FigureData node_rows(const compute::PowerProfile& profile) {
    FigureData data({"qos", "power_w", "error_w", "low_w", "high_w"}, {"line"});
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = qos_of_node(profile, node);
        const double power_w = profile.power_w[node];
        const double error_w = profile.standard_error_w.empty() ? std::nan("") : profile.standard_error_w[node];
        const double reach_w = normal_half_width() * error_w;
        data.add({qos.empty() ? 0.0 : qos.front(), power_w, error_w, power_w - reach_w, power_w + reach_w},
                 {line_name(profile, qos)});
    }
    return data;
}

/// The template's panel without what the profile does not have.
VegaJson panel_of(const compute::Component& component, VegaJson panel) {
    const auto& profile = component.profile;
    auto& nodes = panel["layer"][0];
    auto& tooltip = nodes["encoding"]["tooltip"];  // power over the parameter, further parameters, error
    if (profile.standard_error_w.empty()) {
        tooltip.erase(3);
        nodes["layer"].erase(1);
    }
    if (profile.parameters.size() < 2) {
        tooltip.erase(2);
        nodes["encoding"].erase("color");
    }
    const auto parameter = profile.parameters.empty() ? "no parameter" : valid_utf8(profile.parameters.front());
    return filled(
        std::move(panel),
        {{"nodes", node_rows(profile).json()}, {"parameter", parameter}, {"component", valid_utf8(component.name)}});
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
    std::string text = "Points were profiled, lines are interpolated between them, and nothing is extrapolated.";
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

std::optional<QosMap> qos_map(const mission::MissionSetup& mission) {
    const auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosMap map{axes[0], axes[1], {}, ""};
    auto run = greatest(mission.compute);
    for (std::size_t a = 2; a < axes.size(); ++a) {
        map.others += fmt::format("{}{} {:g}", map.others.empty() ? "" : ", ", axes[a].name, axes[a].nodes.back());
    }
    mission::SimulationOptions steps;
    steps.integration_s = 1.0;  // constant or smooth power: the error is far below a hundredth of a percent
    for (const auto phase : flight::all_phases) steps.output_s = std::max(steps.output_s, mission.duration_s[phase]);
    for (const double y : map.y.nodes) {
        run[map.y.component].qos[map.y.parameter] = y;
        for (const double x : map.x.nodes) {
            run[map.x.component].qos[map.x.parameter] = x;
            const auto summary = simulate(mission, throughout(mission, run), steps).summary;
            map.soc_percent.push_back(summary.final_soc_percent.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    }
    return map;
}

bool have_same_model(const mission::MissionSetup& a, const mission::MissionSetup& b) {
    const auto text = [](const mission::MissionSetup& mission) {
        return mission.mechanical ? to_toml(*mission.mechanical) : std::string();
    };
    return text(a) == text(b);
}

bool have_same_software(const mission::MissionSetup& a, const mission::MissionSetup& b) {
    return std::ranges::equal(
        a.compute.components, b.compute.components, [](const compute::Component& one, const compute::Component& other) {
            return one.name == other.name && one.profile.parameters == other.profile.parameters &&
                   one.profile.axes == other.profile.axes && one.profile.power_w == other.profile.power_w;
        });
}

/// The cruise along the same pieces of power, or both by their models' curves.
bool have_same_path(const mission::MissionSetup& a, const mission::MissionSetup& b) {
    if (!a.cruise_path || !b.cruise_path) return !a.cruise_path && !b.cruise_path;
    return a.cruise_path->pieces->time_s == b.cruise_path->pieces->time_s &&
           a.cruise_path->pieces->energy_j == b.cruise_path->pieces->energy_j;
}

bool have_same_map(const mission::MissionSetup& a, const mission::MissionSetup& b) {
    const auto nameless = [](battery::Battery battery) {
        battery.name.clear();
        return to_toml(battery);
    };
    return a.duration_s.values == b.duration_s.values && a.initial_soc_percent == b.initial_soc_percent &&
           nameless(a.battery) == nameless(b.battery) && have_same_software(a, b) && a.phase_clock == b.phase_clock &&
           have_same_model(a, b) && have_same_path(a, b);
}

Figure qos_map_figure(const QosMap& map, std::span<const SimulatedMission> missions,
                      const std::vector<PublishedCell>& published, const std::string& id) {
    const auto [least, greatest] = range_of(map);
    std::string caption =
        "State of charge at the end if one configuration ran throughout. A cell is the mean of its corners; "
        "diamonds are the configurations that the missions run.";
    if (!map.others.empty()) caption += fmt::format(" With {}.", map.others);
    const auto rms = rms_to_published(map, published);
    if (rms) {
        caption += fmt::format(
            " Discs: the paper's Fig. 4, digitised, on the same colours: one that agrees is seen by its rim "
            "alone. RMS difference over {} cells {:.2f} points.",
            published.size(), *rms);
    }
    const auto x = valid_utf8(map.x.name);
    const auto y = valid_utf8(map.y.name);
    return new_figure(
        "quality", id, caption,
        fmt::format("Final state of charge over {} and {}: from {:.1f} % to {:.1f} % where one configuration runs "
                    "throughout.",
                    map.x.name, map.y.name, least, greatest),
        {{"x", x},
         {"x_from", x + " from"},
         {"x_domain", {map.x.nodes.front(), map.x.nodes.back()}},
         {"y", y},
         {"y_from", y + " from"},
         {"y_domain", {map.y.nodes.front(), map.y.nodes.back()}},
         {"cells", cell_rows(map)},
         {"published", rms ? published_rows(published) : VegaJson()},
         {"markers", marker_rows(map, missions)}});
}

Figure profile_figure(const compute::ComputeModel& compute, const std::string& id) {
    auto figure = new_figure("profile", id, profile_caption(compute), profile_described(compute));
    auto panels = VegaJson::array();
    for (const auto& component : compute.components) panels.push_back(panel_of(component, figure.spec["concat"][0]));
    figure.spec["concat"] = panels;
    return figure;
}

}  // namespace flightwatt::report
