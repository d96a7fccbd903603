#include "mission/prepared_mission.h"

#include "mission/plan.h"

namespace flightwatt::mission {

PreparedMission prepare_mission(const MissionVariant& mission) {
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
        prepared.schedule = std::move(plan.mission.schedule);
        prepared.origin = summary_with_origin(plan).schedule;
    }
    return prepared;
}

SimulatedFlight simulate_prepared(const PreparedMission& prepared, const SimulationOptions& steps,
                                  const Disturbances& disturbances) {
    SimulatedFlight flown;
    std::optional<AdaptiveDecisions> decisions;
    if (prepared.adaptive) {
        auto flight = simulate_adaptive(*prepared.adaptive, prepared.setup, disturbances);
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
