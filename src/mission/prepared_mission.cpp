#include "mission/prepared_mission.h"

#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/simulation/load_segments.h"

#include <utility>

namespace flightwatt::mission {

PreparedMission prepare_mission(const MissionVariant& mission, const std::optional<double>& probability) {
    PreparedMission prepared{setup_of(mission), {}, std::nullopt, ScheduleOrigin::given};
    if (const auto* scheduled = std::get_if<Mission>(&mission)) {
        prepared.schedule = scheduled->schedule;
        return prepared;
    }
    const auto& problem = std::get<PlanningProblem>(mission);
    if (problem.adaptive && !probability) {
        prepared.adaptive = make_adaptive_planner(problem);
        prepared.origin = ScheduleOrigin::replanned;
    } else {
        auto plan = plan_mission(problem, probability);
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

AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances) {
    const auto& known = planner.nominal;
    auto decisions = known;  // whose slots go from one decision to the next
    decisions.fixed.clear();
    decisions.plan.slot_s = known.adaptive->decide_every_s;
    const auto battery = apply_disturbances(actual.battery, disturbances);
    const auto load = make_mission_load(actual);
    FlightReplanner decider(planner);
    battery::Discharge charge{{actual.initial_soc_percent}};
    AdaptiveResult flight;
    for (const auto& interval : make_slots(decisions)) {
        const auto plan = decider.replan({interval.phase, interval.start_s}, charge);
        const auto before = charge;
        const auto run = clip_to_interval(plan.schedule, interval);
        for (const auto& planned : run) append_merged(flight.schedule, planned);
        for (const auto& flown : rescale_to_flown_durations(run, known.setup.duration_s, actual.duration_s))
            for (const auto& segment : disturbed(load_segments(load, flown), disturbances))
                charge = advance_segment(battery, actual.cutoff_voltage_v, segment, charge);
        decider.update(interval, run, before, charge.soc_percent);
        ++flight.decisions.made;
        if (!plan.feasible) ++flight.decisions.without_plan;
    }
    flight.schedule = rescale_to_flown_durations(std::move(flight.schedule), known.setup.duration_s, actual.duration_s);
    flight.decisions.mechanical_factor = decider.mechanical_factor();
    return flight;
}

}  // namespace flightwatt::mission
