#include "report/simulated_mission.h"

#include "base/utf8.h"
#include "compute/qos_range.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "report/figure.h"

#include <map>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Flights drawn a mission: the chance of landing below the reserve then has a standard error of 1.6 percent points at
/// most. A policy plans the rest of each anew in every slot, some thousand times the work: 3.5 points.
constexpr std::size_t flights_drawn = 1000;
constexpr std::size_t flights_drawn_of_policy = 200;
/// Of the band over time.
constexpr std::size_t band_times = 61;

/// Flies a mission, planned first where it is yet to be, or in flight where a policy does; flights are drawn
/// where something says how they differ. The answer is the same at every run.
SimulatedMission fly_for_report(const mission::MissionVariant& mission, const mission::SimulationOptions& steps) {
    SimulatedMission simulated;
    mission::PreparedMission prepared;
    std::optional<mission::MissionSummary> summary;  // of a plan, as finely simulated as it was made
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem != nullptr && !problem->adaptive) {
        const auto plan = plan_mission(*problem);
        simulated.planned = PlannedSchedule{plan.plan.feasible, plan.plan.utility_bound, plan.margin_percent};
        prepared = {*problem, plan.mission.schedule, std::nullopt, mission::ScheduleOrigin::planned};
        summary = summary_with_origin(plan);
    } else {
        prepared = prepare_mission(mission);
    }
    auto flown = simulate_prepared(prepared, steps);
    simulated.simulation = std::move(flown.simulation);
    if (summary) {
        summary->by_flights = simulated.simulation.summary.by_flights;
        simulated.simulation.summary = std::move(*summary);
    }
    if (has_uncertainty(prepared.setup))
        simulated.simulation.summary.samples =
            sample_flights(prepared, {}, {prepared.adaptive ? flights_drawn_of_policy : flights_drawn, 1, band_times});
    simulated.mission = {std::move(prepared.setup), std::move(flown.schedule)};
    return simulated;
}

}  // namespace

std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::MissionVariant>& missions,
                                                  const Progress& progress) {
    constexpr double rows = 300.0;
    std::vector<SimulatedMission> simulated;
    std::map<std::string, int> seen;
    for (const auto& mission : missions) {
        if (progress) progress(simulated.size(), missions.size());
        const auto& setup = setup_of(mission);
        mission::SimulationOptions steps;
        steps.output_s = mission::timeline_of(setup.duration_s).duration_s / rows;
        auto title = valid_utf8(setup.name);
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
        if (!running.qos.empty()) text += " " + compute::format_qos(component.profile.parameters, running.qos, " ");
    }
    return text.empty() ? "nothing" : text;
}

}  // namespace flightwatt::report
