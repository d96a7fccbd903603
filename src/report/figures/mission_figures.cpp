#include "report/figures/mission_figures.h"

#include "base/statistics.h"
#include "base/text.h"
#include "battery/battery_toml.h"
#include "compute/compute_model.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "mission/schedule.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/algorithm/string/replace.hpp>
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

/// "key bits" for "key_bits".
std::string in_words(const std::string& parameter) { return boost::replace_all_copy(parameter, "_", " "); }

std::vector<QosAxis> axes_of(const compute::ComputeModel& compute) {
    std::vector<QosAxis> axes;
    for (std::size_t c = 0; c < compute.components.size(); ++c) {
        const auto& [name, profile] = compute.components[c];
        for (std::size_t p = 0; p < profile.parameters.size(); ++p) {
            axes.push_back({c, p, name + " " + in_words(profile.parameters[p]), with_thirds(profile.axes[p])});
        }
    }
    return axes;
}

/// Schedules of one configuration throughout, for each value of two parameters, x running fastest; the others have
/// their maximum.
std::vector<std::vector<mission::ScheduleSegment>> schedules_of(const mission::MissionSetup& mission, const QosAxis& x,
                                                                const QosAxis& y) {
    compute::Configuration run;
    for (std::size_t c = 0; c < mission.compute.components.size(); ++c) {
        run.push_back({c, {}});
        for (const auto& axis : mission.compute.components[c].profile.axes) run.back().qos.push_back(axis.back());
    }
    std::vector<std::vector<mission::ScheduleSegment>> schedules;
    for (const double y_value : y.nodes) {
        run[y.component].qos[y.parameter] = y_value;
        for (const double x_value : x.nodes) {
            run[x.component].qos[x.parameter] = x_value;
            schedules.emplace_back();
            for (const auto phase : flight::all_phases)
                if (mission.duration_s[phase] > 0.0)
                    schedules.back().push_back({phase, 0.0, mission.duration_s[phase], run});
        }
    }
    return schedules;
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

/// The parameters but the first.
std::string line_name(const compute::PowerProfile& profile, const std::vector<double>& qos) {
    std::vector<std::string> parts;
    for (std::size_t p = 1; p < qos.size(); ++p) {
        parts.push_back(fmt::format("{} {:g}", in_words(profile.parameters[p]), qos[p]));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
}

FigureData node_rows(const compute::PowerProfile& profile) {
    FigureData data({"qos", "power_w", "error_w", "low_w", "high_w"}, {"line"});
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = compute::grid_point(profile.axes, node);
        const double power_w = profile.power_w[node];
        const double error_w = profile.standard_error_w.empty() ? std::nan("") : profile.standard_error_w[node];
        const double reach_w = normal_half_width() * error_w;
        data.add({qos.empty() ? 0.0 : qos.front(), power_w, error_w, power_w - reach_w, power_w + reach_w},
                 {line_name(profile, qos)});
    }
    return data;
}

/// The template's panel, with further parameters and errors only if the profile has them.
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
    const auto parameter =
        profile.parameters.empty() ? "no parameter" : valid_utf8(in_words(profile.parameters.front()));
    return fill_template(
        std::move(panel),
        {{"nodes", node_rows(profile).json()}, {"parameter", parameter}, {"component", valid_utf8(component.name)}});
}

using Missions = std::span<const SimulatedMission>;

/// A bar for each segment of a schedule.
VegaJson strip_rows(Missions missions) {
    FigureData data({"start_s", "end_s", "compute_w"}, {"mission", "phase", "runs"});
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        const auto timeline = mission::timeline_of(mission.setup.duration_s);
        for (const auto& segment : mission.schedule) {
            const double start_s = timeline.start_s[segment.phase];
            data.add({start_s + segment.start_s, start_s + segment.end_s, power_w(mission.setup.compute, segment.run)},
                     {simulated.title, phase_word(segment.phase), describe(mission.setup.compute, segment.run)});
        }
    }
    return data.json();
}

}  // namespace

std::optional<QosMap> qos_map(const mission::MissionSetup& mission) {
    const auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosMap map{axes[0], axes[1], {}, ""};
    for (std::size_t a = 2; a < axes.size(); ++a) {
        map.others += fmt::format("{}{} {:g}", map.others.empty() ? "" : ", ", axes[a].name, axes[a].nodes.back());
    }
    mission::SimulationOptions steps;
    steps.integration_s = 1.0;  // power is constant or smooth: error below 0.01 %
    for (const auto phase : flight::all_phases) steps.output_s = std::max(steps.output_s, mission.duration_s[phase]);
    for (const auto& schedule : schedules_of(mission, map.x, map.y))
        map.soc_percent.push_back(simulate(mission, schedule, steps).summary.final_soc_percent.value_or(std::nan("")));
    return map;
}

std::optional<QosGrid> qos_grid(const mission::MissionSetup& mission) {
    constexpr std::size_t max_values = 8;
    constexpr std::size_t flights_drawn = 200;
    constexpr double rows = 40.0;
    auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosGrid grid{axes[0], axes[1], {}};
    for (auto* axis : {&grid.x, &grid.y})
        axis->nodes =
            evenly_chosen(mission.compute.components[axis->component].profile.axes[axis->parameter], max_values);
    mission::SimulationOptions steps;
    steps.output_s = mission::timeline_of(mission.duration_s).duration_s / rows;
    for (const auto& schedule : schedules_of(mission, grid.x, grid.y)) {
        const mission::PreparedMission prepared{mission, schedule, std::nullopt};
        QosCell cell{simulate_prepared(prepared, steps).simulation, std::nullopt};
        if (has_uncertainty(mission)) {
            const auto drawn = sample_flights(prepared, {}, {flights_drawn, 1});
            if (drawn.variability_is_known) cell.probability = 1.0 - drawn.probability_below_reserve;
        }
        grid.cells.push_back(std::move(cell));
    }
    return grid;
}

std::string model_key(const mission::MissionSetup& mission) {
    return mission.mechanical ? to_toml(*mission.mechanical) : std::string();
}

std::string software_key(const mission::MissionSetup& mission) {
    std::string key;
    for (const auto& [name, profile] : mission.compute.components)
        key += fmt::format("{} {} {} {}\n", name, profile.parameters, profile.axes, profile.power_w);
    return key;
}

std::string map_key(const mission::MissionSetup& mission) {
    auto battery = mission.battery;
    battery.name.clear();
    auto key = fmt::format("{} {} {}\n", mission.duration_s.values, mission.initial_soc_percent,
                           static_cast<int>(mission.phase_clock)) +
               to_toml(battery) + software_key(mission) + model_key(mission);
    if (const auto& cruise = mission.cruise_path)
        key += fmt::format("{} {}\n", cruise->pieces->time_s, cruise->pieces->energy_j);
    return key;
}

Figure qos_map_figure(const QosMap& map, const std::string& id) {
    std::string caption =
        "Final state of charge if one configuration runs throughout. A cell is the mean of its corners.";
    if (!map.others.empty()) caption += fmt::format(" With {}.", map.others);
    const auto x = valid_utf8(map.x.name);
    const auto y = valid_utf8(map.y.name);
    return new_figure("quality", id, caption,
                      fmt::format("Final state of charge over {} and {}, where one configuration runs throughout.",
                                  map.x.name, map.y.name),
                      {{"x", x},
                       {"x_from", x + " from"},
                       {"x_domain", {map.x.nodes.front(), map.x.nodes.back()}},
                       {"y", y},
                       {"y_from", y + " from"},
                       {"y_domain", {map.y.nodes.front(), map.y.nodes.back()}},
                       {"cells", cell_rows(map)}});
}

Figure profile_figure(const compute::ComputeModel& compute, const std::string& id) {
    auto figure = new_figure("profile", id,
                             "Points were profiled, with 95 % intervals where standard errors are known; lines are "
                             "interpolated. In a mission, the powers of the running components add up.",
                             "Profiled power of on-board software over its quality of service.");
    auto panels = VegaJson::array();
    for (const auto& component : compute.components) panels.push_back(panel_of(component, figure.spec["concat"][0]));
    figure.spec["concat"] = panels;
    return figure;
}

Figure schedule_figure(Missions missions, const VegaJson& data, const std::string& id) {
    const auto& phases = data.front()["phases"];
    const bool are_common =
        std::ranges::all_of(data, [&](const VegaJson& mission) { return mission["phases"] == phases; });
    double end_s = 0.0;
    auto titles = VegaJson::array();
    auto shown = VegaJson::array();
    std::string description = "State of charge over the mission.";
    bool has_software = false;
    for (const auto& mission : missions) {
        end_s = std::max(end_s, mission.simulation.summary.duration_s);
        titles.push_back(mission.title);
        shown.push_back({{"title", mission.title}});
        description += fmt::format(" {}.", describe(mission.simulation.summary));
        has_software = has_software || !mission.mission.setup.compute.components.empty();
    }
    std::string caption =
        "A click on the legend hides a mission. Shaded, where uncertainty is known: 5 to 95 % of the drawn flights. "
        "Dashed horizontal lines: the reserve.";
    if (has_software) caption += " Below: the schedules, coloured by their power.";
    auto figure = new_figure("schedule", id, caption, description,
                             {{"end_s", end_s},
                              {"titles", titles},
                              {"shown", shown},
                              {"missions", data},
                              {"phases", are_common ? VegaJson{{"values", phases}} : VegaJson()},
                              {"strip", strip_rows(missions)}});
    if (!has_software) figure.spec["vconcat"].erase(1);
    return figure;
}

}  // namespace flightwatt::report
