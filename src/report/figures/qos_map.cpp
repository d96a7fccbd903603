#include "report/figures/qos_map.h"

#include "mission/simulation.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// The profiled values, and two more between each of them: the paper's grid.
std::vector<double> with_thirds(const std::vector<double>& profiled) {
    std::vector<double> nodes{profiled.front()};
    for (std::size_t i = 1; i < profiled.size(); ++i) {
        for (int third = 1; third <= 3; ++third) {
            nodes.push_back(std::lerp(profiled[i - 1], profiled[i], third / 3.0));
        }
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

bool same_profiles(const compute::ComputeModel& a, const compute::ComputeModel& b) {
    if (a.components.size() != b.components.size()) return false;
    for (std::size_t c = 0; c < a.components.size(); ++c) {
        const auto& one = a.components[c].profile;
        const auto& other = b.components[c].profile;
        if (a.components[c].name != b.components[c].name || one.parameters != other.parameters ||
            one.axes != other.axes || one.power_w != other.power_w) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::optional<QosMap> qos_map(const mission::MissionSetup& mission) {
    const auto axes = axes_of(mission.compute);
    if (axes.size() < 2) return std::nullopt;
    QosMap map{axes[0], axes[1], {}, ""};
    auto run = greatest(mission.compute);
    for (std::size_t a = 2; a < axes.size(); ++a) {
        map.others +=
            fmt::format("{}{} {:g}", map.others.empty() ? "" : ", ", axes[a].name, axes[a].nodes.back());
    }
    mission::SimulationSteps steps;
    steps.integration_s = 1.0;  // constant or smooth power: the error is far below a hundredth of a percent
    for (const auto phase : flight::all_phases)
        steps.output_s = std::max(steps.output_s, mission.duration_s[phase]);
    for (const double y : map.y.nodes) {
        run[map.y.component].qos[map.y.parameter] = y;
        for (const double x : map.x.nodes) {
            run[map.x.component].qos[map.x.parameter] = x;
            const auto summary = simulate(mission, throughout(mission, run), steps).summary;
            map.soc_percent.push_back(
                summary.final_soc_percent.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    }
    return map;
}

bool have_same_map(const mission::MissionSetup& a, const mission::MissionSetup& b) {
    const auto mechanical = [](const mission::MissionSetup& mission) {
        return mission.mechanical ? to_toml(*mission.mechanical) : std::string();
    };
    const auto nameless = [](battery::Battery battery) {
        battery.name.clear();
        return to_toml(battery);
    };
    return a.duration_s.values == b.duration_s.values && a.initial_soc_percent == b.initial_soc_percent &&
           nameless(a.battery) == nameless(b.battery) && same_profiles(a.compute, b.compute) &&
           a.phase_clock == b.phase_clock && mechanical(a) == mechanical(b);
}

}  // namespace flightwatt::report
