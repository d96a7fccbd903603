#include "mission/replanning/adaptive_flight.h"

#include "base/error.h"
#include "mission/flight_replanner.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

void require_few_decisions(const PlanningProblem& known) {
    constexpr double most = 20000.0;
    const double decisions = timeline_of(known.duration_s).duration_s / known.adaptive->decide_every_s;
    if (decisions <= most) return;
    throw InputError({known.file},
                     fmt::format("a plan every {:.6g} s makes {:.3g} plans, more than {:.0f}",
                                 known.adaptive->decide_every_s, decisions, most),
                     "make decide_every_s in [policy] longer");
}

/// The times from one decision to the next, as planned.
std::vector<PhaseSegment> intervals_of(const PlanningProblem& known) {
    std::vector<PhaseSegment> intervals;
    for (const auto phase : all_phases) {
        const double duration_s = known.duration_s[phase];
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
            rescale_to_flown_durations(std::move(flight_.schedule), known_.duration_s, actual_.duration_s);
        flight_.decisions.mechanical_factor = decider_.mechanical_factor();
        return std::move(flight_);
    }

  private:
    /// Runs a segment of the plan in the flight as it is.
    void fly(const ScheduleSegment& planned) {
        append_merged(flight_.schedule, planned);
        const auto flown = rescale_to_flown_durations({planned}, known_.duration_s, actual_.duration_s);
        for (const auto& segment : disturbed(split_at_jumps(load_segment(load_, flown.front())), disturbances_))
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

AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem) {
    if (!problem.adaptive) throw std::invalid_argument("make_adaptive_planner: the policy is not adaptive");
    require_few_decisions(problem);
    AdaptivePlanner planner{problem, make_planning_tables(problem)};
    if (auto& step_s = planner.planner.step_s) {
        double quick_s = 2.0;  // what that is off is far below what flights differ by
        if (problem.battery.thevenin) quick_s = std::min(quick_s, problem.battery.thevenin->rc_time_constant_s / 2.0);
        step_s = std::max(*step_s, quick_s);
    }
    return planner;
}

AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances) {
    Flight flight(planner, actual, disturbances);
    for (const auto& interval : intervals_of(planner.nominal)) flight.fly(interval);
    return flight.landed();
}

}  // namespace flightwatt::mission
