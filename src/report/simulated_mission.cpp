#include "report/simulated_mission.h"

#include "mission/flight_draws.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "report/figure.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Flights drawn a mission: the chance of landing below the reserve is then known to 1.6 percent points.
constexpr std::size_t flights_drawn = 1000;

/// Draws flights where something says how they differ; the answer is the same at every run.
void sample_for_report(const mission::Flyable& flyable, mission::MissionSummary& summary) {
    if (has_spread(flyable.mission)) summary.samples = sample_flights(flyable, {}, {flights_drawn, 1, 0});
}

/// Flies a mission, planned first where it is yet to be, or in flight where a policy does.
SimulatedMission fly_for_report(const mission::Mission& mission, const mission::SimulationSteps& steps) {
    SimulatedMission flown;
    if (!mission.plan || mission.adaptive) {
        const auto flyable = make_flyable(mission);
        auto flight = fly(flyable, steps);
        flown.simulation = std::move(flight.simulation);
        sample_for_report(flyable, flown.simulation.summary);
        flown.mission = std::move(flight.flown);
        return flown;
    }
    auto plan = plan_mission(mission);
    flown.simulation = simulate(plan.flown, steps);
    flown.simulation.summary = labelled_summary(plan);
    sample_for_report({plan.flown, std::nullopt, "", true}, flown.simulation.summary);
    flown.planned = PlannedSchedule{plan.plan.feasible, plan.plan.bound, plan.margin_percent};
    flown.mission = std::move(plan.flown);
    return flown;
}

}  // namespace

std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::Mission>& missions) {
    constexpr double rows = 300.0;
    std::vector<SimulatedMission> simulated;
    std::map<std::string, int> seen;
    for (const auto& mission : missions) {
        const auto& durations_s = mission.duration_s.values;
        mission::SimulationSteps steps;
        steps.output_s = std::accumulate(durations_s.begin(), durations_s.end(), 0.0) / rows;
        auto title = valid_utf8(mission.name);
        if (const int times = ++seen[title]; times > 1) title += fmt::format(" ({})", times);
        simulated.push_back(fly_for_report(mission, steps));
        simulated.back().title = std::move(title);
    }
    return simulated;
}

std::string describe(const compute::ComputeModel& compute, const compute::Configuration& run) {
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

}  // namespace flightwatt::report
