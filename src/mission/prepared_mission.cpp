#include "mission/prepared_mission.h"

#include "mission/plan.h"

namespace flightwatt::mission {

Flyable make_flyable(const Mission& mission) {
    Flyable flyable{mission, std::nullopt, "", true};
    if (mission.adaptive) {
        flyable.adaptive = make_adaptive_planner(mission);
        flyable.schedule = "replanned in flight";
    } else if (mission.plan) {
        const auto plan = plan_mission(mission);
        flyable.mission = plan.flown;
        flyable.schedule = labelled_summary(plan).schedule;
        flyable.planned_feasibly = plan.plan.feasible;
    }
    return flyable;
}

FlownMission fly(const Flyable& flyable, const SimulationSteps& steps,
                 const std::vector<Disturbance>& disturbances) {
    FlownMission result;
    std::optional<Decisions> decisions;
    if (flyable.adaptive) {
        auto flight = fly_adaptively(*flyable.adaptive, flyable.mission, disturbances);
        result.flown = std::move(flight.flown);
        decisions = flight.decisions;
    } else {
        result.flown = flyable.mission;
    }
    result.simulation = simulate(result.flown, steps, disturbances);
    auto& summary = result.simulation.summary;
    summary.schedule = flyable.schedule;
    summary.feasible = summary.feasible && flyable.planned_feasibly;
    summary.lacks_plan = !flyable.planned_feasibly;
    summary.decisions = decisions;
    return result;
}

}  // namespace flightwatt::mission
