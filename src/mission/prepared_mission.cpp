#include "mission/prepared_mission.h"

#include "mission/plan.h"
#include "mission/simulation/load_segments.h"

#include <cmath>
#include <utility>
#include <vector>

namespace flightwatt::mission {
namespace {

/// The times from one decision to the next, as planned.
std::vector<PhaseSegment> intervals_of(const PlanningProblem& known) {
    std::vector<PhaseSegment> intervals;
    for (const auto phase : all_phases) {
        const double duration_s = known.setup.duration_s[phase];
        const double every_s = known.adaptive->decide_every_s;
        const auto count =
            static_cast<std::size_t>(std::ceil((duration_s - same_time_tolerance_s(duration_s)) / every_s));
        for (std::size_t k = 0; k < count; ++k) {
            const double start_s = static_cast<double>(k) * every_s;
            intervals.push_back({phase, start_s, k + 1 == count ? duration_s : start_s + every_s});
        }
    }
    return intervals;
}

/// One flight in the air.
class Flight {
  public:
    Flight(const AdaptivePlanner& planner, const MissionSetup& actual, const Disturbances& disturbances)
        : known_(planner.nominal),
          actual_(actual),
          disturbances_(disturbances),
          battery_(apply_disturbances(actual.battery, disturbances)),
          load_(make_mission_load(actual)),
          decider_(planner) {
        charge_.soc_percent = actual.initial_soc_percent;
    }

    void fly(const PhaseSegment& interval) {
        const auto plan = decider_.replan({interval.phase, interval.start_s}, charge_);
        const auto before = charge_;
        const auto run = clip_to_interval(plan.schedule, interval);
        for (const auto& segment : run) fly(segment);
        decider_.update(interval, run, before, charge_.soc_percent);
        ++flight_.decisions.made;
        if (!plan.feasible) ++flight_.decisions.without_plan;
    }

    AdaptiveResult landed() {
        flight_.schedule =
            rescale_to_flown_durations(std::move(flight_.schedule), known_.setup.duration_s, actual_.duration_s);
        flight_.decisions.mechanical_factor = decider_.mechanical_factor();
        return std::move(flight_);
    }

  private:
    /// Runs a segment of the plan in the flight as it is.
    void fly(const ScheduleSegment& planned) {
        append_merged(flight_.schedule, planned);
        const auto flown = rescale_to_flown_durations({planned}, known_.setup.duration_s, actual_.duration_s);
        for (const auto& segment : disturbed(load_segments(load_, flown.front()), disturbances_))
            charge_ = advance_segment(battery_, actual_.cutoff_voltage_v, segment, charge_);
    }

    const PlanningProblem& known_;
    const MissionSetup& actual_;
    const Disturbances& disturbances_;
    battery::Battery battery_;  ///< as it really is
    MissionLoad load_;          ///< of the mission as it really is
    FlightReplanner decider_;
    AdaptiveResult flight_;
    battery::Discharge charge_;
};

}  // namespace

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

AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances) {
    Flight flight(planner, actual, disturbances);
    for (const auto& interval : intervals_of(planner.nominal)) flight.fly(interval);
    return flight.landed();
}

}  // namespace flightwatt::mission
