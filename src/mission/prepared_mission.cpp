#include "mission/prepared_mission.h"

#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/simulation/load_segments.h"

#include <memory>
#include <utility>

namespace flightwatt::mission {
namespace {

using Pieces = std::shared_ptr<const path::PiecewisePower>;

/// The power repeated from its start until it takes a time.
Pieces repeated_up_to(const Pieces& measured, double duration_s) {
    auto pieces = *measured;
    while (pieces.time_s.back() < duration_s) {
        const double start_s = pieces.time_s.back();
        const double start_j = pieces.energy_j.back();
        for (std::size_t i = 1; i < measured->time_s.size(); ++i) {
            pieces.time_s.push_back(start_s + measured->time_s[i]);
            pieces.energy_j.push_back(start_j + measured->energy_j[i]);
        }
    }
    return std::make_shared<const path::PiecewisePower>(std::move(pieces));
}

}  // namespace

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
        prepared.setup = std::move(plan.mission.setup);
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
        flown.setup = std::move(flight.setup);
    } else {
        flown.schedule = prepared.schedule;
    }
    const auto& setup = flown.setup ? *flown.setup : prepared.setup;
    flown.simulation = simulate(setup, flown.schedule, steps, disturbances);
    auto& summary = flown.simulation.summary;
    summary.schedule = prepared.origin;
    summary.feasible = summary.feasible && prepared.origin != ScheduleOrigin::infeasible;
    summary.decisions = decisions;
    summary.by_flights = landing_by_flights(setup, flown.schedule, disturbances);
    return flown;
}

MissionSetup actual_with_lines(const MissionSetup& first, const MissionSetup& chosen, const MissionSetup& actual) {
    const double longer = actual.duration_s[Phase::cruise] / first.duration_s[Phase::cruise];
    auto flown = actual;
    flown.survey = chosen.survey;
    flown.uncertain = chosen.uncertain;
    flown.notes = chosen.notes;
    flown.cruise_level = chosen.cruise_level;
    flown.duration_s[Phase::cruise] = chosen.duration_s[Phase::cruise] * longer;
    if (auto& measured = flown.measured_power[Phase::cruise]) {
        measured = repeated_up_to(measured, flown.duration_s[Phase::cruise]);
        return flown;
    }
    const double more = energy_j(*actual.cruise_path) / energy_j(*first.cruise_path);
    auto pieces = *chosen.cruise_path->pieces;
    for (auto& time_s : pieces.time_s) time_s *= longer;
    for (auto& energy_j : pieces.energy_j) energy_j *= more;
    flown.cruise_path->plan = chosen.cruise_path->plan;
    flown.cruise_path->pieces = std::make_shared<const path::PiecewisePower>(std::move(pieces));
    return flown;
}

AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances) {
    FlightReplanner decider(planner);
    auto decisions = planner.nominal;  // whose slots go from one decision to the next
    decisions.fixed.clear();
    decisions.plan.slot_s = planner.nominal.adaptive->decide_every_s;
    const auto battery = apply_disturbances(actual.battery, disturbances);
    std::optional<MissionLoad> load(make_mission_load(actual));
    auto flown_s = actual.duration_s;
    battery::Discharge charge{{actual.initial_soc_percent}};
    AdaptiveResult flight;
    auto intervals = make_slots(decisions);
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        const auto plan = decider.replan({intervals[i].phase, intervals[i].start_s}, charge);
        const auto& known = decider.problem().setup;
        if (known.survey && known.survey->layout != decisions.setup.survey->layout) {
            const double now_s = timeline_of(known.duration_s).start_s[intervals[i].phase] + intervals[i].start_s;
            decisions.setup = known;
            intervals = make_slots(decisions, now_s);
            i = 0;
            flight.setup = actual_with_lines(planner.nominal.setup, known, actual);
            load.emplace(make_mission_load(*flight.setup));
            flown_s = flight.setup->duration_s;
        }
        const auto& interval = intervals[i];
        const auto before = charge;
        const auto run = clip_to_interval(plan.schedule, interval);
        for (const auto& planned : run) append_merged(flight.schedule, planned);
        for (const auto& flown : rescale_to_flown_durations(run, known.duration_s, flown_s))
            for (const auto& segment : disturbed(load_segments(*load, flown), disturbances))
                charge = advance_segment(battery, actual.cutoff_voltage_v, segment, charge);
        decider.update(interval, run, before, charge.soc_percent);
        ++flight.decisions.made;
        if (!plan.feasible) ++flight.decisions.without_plan;
    }
    flight.schedule = rescale_to_flown_durations(std::move(flight.schedule), decisions.setup.duration_s, flown_s);
    flight.decisions.mechanical_factor = decider.mechanical_factor();
    return flight;
}

}  // namespace flightwatt::mission
