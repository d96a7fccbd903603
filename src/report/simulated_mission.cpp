#include "report/simulated_mission.h"

#include "mission/flyable.h"
#include "report/figure.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt {

std::vector<SimulatedMission> simulate_for_report(std::vector<Mission> missions) {
    constexpr double rows = 300.0;
    std::vector<SimulatedMission> simulated;
    std::map<std::string, int> seen;
    for (auto& mission : missions) {
        const auto& durations_s = mission.duration_s.values;
        SimulationSteps steps;
        steps.output_s = std::accumulate(durations_s.begin(), durations_s.end(), 0.0) / rows;
        auto title = valid_utf8(mission.name);
        if (const int times = ++seen[title]; times > 1) title += fmt::format(" ({})", times);
        auto [flown, simulation] = fly(make_flyable(mission), steps);
        simulated.push_back({std::move(flown), std::move(simulation), std::move(title)});
    }
    return simulated;
}

std::string describe(const ComputeModel& compute, const Configuration& run) {
    std::string text;
    for (const auto& running : run) {
        const auto& component = compute.components[running.component];
        text += (text.empty() ? "" : ", ") + component.name;
        for (std::size_t p = 0; p < running.qos.size(); ++p) {
            text += fmt::format(" {} {:g}", component.profile.parameters[p], running.qos[p]);
        }
    }
    return text.empty() ? "nothing" : text;
}

}  // namespace flightwatt
