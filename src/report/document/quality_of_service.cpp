#include "report/document/quality_of_service.h"

#include "battery/battery_toml.h"
#include "compute/compute_model.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <span>
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

/// The values of the parameters after the first two: "planner rate 5".
std::string other_values(std::span<const QosAxis> axes) {
    std::vector<std::string> others;
    for (const auto& axis : axes.subspan(2)) others.push_back(fmt::format("{} {:g}", axis.name, axis.nodes.back()));
    return fmt::format("{}", fmt::join(others, ", "));
}

}  // namespace

std::string in_words(const std::string& parameter) { return boost::replace_all_copy(parameter, "_", " "); }

std::optional<QosMap> qos_map(const mission::MissionSetup& mission) {
    const auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosMap map{axes[0], axes[1], {}};
    for (const auto& schedule : schedules_of(mission, map.x, map.y))
        map.soc_percent.push_back(
            simulate(mission, schedule, {.with_curve = false}).summary.final_soc_percent.value_or(std::nan("")));
    return map;
}

std::optional<QosGrid> qos_grid(const mission::MissionSetup& mission) {
    constexpr std::size_t max_values = 8;
    constexpr double rows = 40.0;
    auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosGrid grid{axes[0], axes[1], {}, other_values(axes)};
    for (auto* axis : {&grid.x, &grid.y})
        axis->nodes =
            evenly_chosen(mission.compute.components[axis->component].profile.axes[axis->parameter], max_values);
    mission::SimulationOptions steps;
    steps.output_s = mission::timeline_of(mission.duration_s).duration_s / rows;
    for (const auto& schedule : schedules_of(mission, grid.x, grid.y)) {
        const mission::PreparedMission prepared{mission, schedule, std::nullopt};
        QosCell cell{simulate_prepared(prepared, steps).simulation, std::nullopt};
        if (has_uncertainty(mission)) {
            const auto drawn = sample_flights(prepared, {}, {grid_flights_drawn, 1});
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

}  // namespace flightwatt::report
