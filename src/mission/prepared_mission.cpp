#include "mission/prepared_mission.h"

#include "mission/plan.h"

namespace flightwatt::mission {

PreparedMission prepare(const AnyMission& mission) {
    PreparedMission prepared{setup_of(mission), {}, std::nullopt, ScheduleOrigin::given};
    if (const auto* scheduled = std::get_if<Mission>(&mission)) {
        prepared.schedule = scheduled->schedule;
        return prepared;
    }
    const auto& problem = std::get<PlanningProblem>(mission);
    if (problem.adaptive) {
        prepared.adaptive = make_adaptive_planner(problem);
        prepared.origin = ScheduleOrigin::replanned;
    } else {
        auto plan = plan_mission(problem);
        prepared.schedule = std::move(plan.flown.schedule);
        prepared.origin = labelled_summary(plan).schedule;
    }
    return prepared;
}

FlownMission fly(const PreparedMission& prepared, const SimulationSteps& steps, const Disturbances& disturbances) {
    FlownMission flown;
    std::optional<AdaptiveDecisions> decisions;
    if (prepared.adaptive) {
        auto flight = fly_adaptively(*prepared.adaptive, prepared.setup, disturbances);
        flown.schedule = std::move(flight.schedule);
        decisions = flight.decisions;
    } else {
        flown.schedule = prepared.schedule;
    }
    flown.simulation = simulate(prepared.setup, flown.schedule, steps, disturbances);
    auto& summary = flown.simulation.summary;
    summary.schedule = prepared.origin;
    summary.feasible = summary.feasible && prepared.origin != ScheduleOrigin::infeasible;
    summary.decisions = decisions;
    summary.by_flights = landing_by_flights(prepared.setup, flown.schedule, disturbances);
    return flown;
}

}  // namespace flightwatt::mission
