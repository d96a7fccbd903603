#include "mission/replanning/adaptive_flight.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// Of tables: the relaxation's plan leaves at most what one slot could spend, and the next decision spends it; only near
/// the end does a search pay. Where the battery's state counts, a few labels follow it all the way.
KnapsackEffort effort_for(const Planner& planner, double slots_left) {
    constexpr double searched_slots = 8.0;
    const bool searches = slots_left <= searched_slots;
    if (planner.step_s) return {1e-4, searches ? std::size_t{200} : std::size_t{20}, 16};
    return {searches ? 1e-4 : 1.0, 200};
}

constexpr double jump_factor = 2.0;  ///< of the depletion predicted: beyond, charge was lost otherwise

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

/// Seconds flown and points lost so far, where they tell of mechanical power.
struct Learned {
    double time_s = 0.0;
    double observed_percent = 0.0;
    double predicted_percent = 0.0;
    double mechanical_percent = 0.0;

    double factor(const AdaptivePolicy& policy) const {
        if (mechanical_percent <= 0.0) return 1.0;
        const double gain = time_s / (time_s + policy.learning_time_s);
        return std::max(0.0, 1.0 + gain * (observed_percent - predicted_percent) / mechanical_percent);
    }
};

/// What a part of a flight depletes [points], as predicted.
struct PredictedDepletion {
    double percent = 0.0;
    double mechanical_percent = 0.0;  ///< how much more by mechanical power of twice as much
};

/// The same of a battery whose state counts, from that state on.
PredictedDepletion predicted_by_state(const MissionLoad& known, const Schedule& run,
                                      const battery::BatteryState& state) {
    constexpr double more = 0.01;
    const auto lost_percent = [&](double mechanical_factor) {
        Disturbance wind;
        wind.mechanical_factor = mechanical_factor;
        battery::Discharge now{state};
        for (const auto& scheduled : run)
            for (const auto& segment : disturbed({load_segment(known, scheduled)}, {wind}))
                now = after_segment(known.mission.battery, 0.0, segment, now);
        return state.soc_percent - now.soc_percent;
    };
    const double percent = lost_percent(1.0);
    return {percent, (lost_percent(1.0 + more) - percent) / more};
}

/// One flight in the air.
class Flight {
  public:
    Flight(const AdaptivePlanner& planner, const MissionSetup& actual, const Disturbances& disturbances)
        : adaptive_(planner),
          known_(planner.known),
          actual_(actual),
          disturbances_(disturbances),
          battery_(disturbed(actual.battery, disturbances)),
          planned_(timeline_of(known_.duration_s)),
          known_load_(load_of(known_)),
          load_(load_of(actual)) {
        charge_.soc_percent = actual.initial_soc_percent;
        const auto& policy = *known_.adaptive;
        reach_ = policy.mechanical_sd_percent / units::percent_per_whole * normal_quantile(policy.probability);
        if (state_counts()) return;
        for (const auto phase : all_phases)
            if (known_.duration_s[phase] > 0.0)
                rest_mechanical_percent_ += mechanical_percent({phase, 0.0, known_.duration_s[phase]});
    }

    void fly(const PhaseSegment& interval) {
        Schedule run;
        for (const auto& planned : decide(interval)) {
            if (planned.phase != interval.phase || planned.start_s >= interval.end_s) break;
            run.push_back(planned);
            run.back().end_s = std::min(planned.end_s, interval.end_s);
        }
        const auto predicted = predict(interval, run);
        const double before_percent = charge_.soc_percent;
        for (const auto& segment : run) fly(segment);
        learn(interval, before_percent - charge_.soc_percent, predicted);
    }

    AdaptiveFlight landed() {
        flight_.schedule =
            rescale_to_flown_durations(std::move(flight_.schedule), known_.duration_s, actual_.duration_s);
        flight_.decisions.mechanical_factor = learned_.factor(*known_.adaptive);
        return std::move(flight_);
    }

  private:
    double mechanical_percent(const PhaseSegment& time) const {
        return soc_depletion_percent(adaptive_.planner.mechanical_depletion, {time, 0});
    }

    bool state_counts() const { return adaptive_.planner.step_s.has_value(); }

    PredictedDepletion predict(const PhaseSegment& interval, const Schedule& run) const {
        if (state_counts()) return predicted_by_state(known_load_, run, charge_);
        PredictedDepletion predicted{0.0, mechanical_percent(interval)};
        const auto& table = adaptive_.planner.depletions;
        for (const auto& segment : tabled(run, table)) predicted.percent += soc_depletion_percent(table, segment);
        return predicted;
    }

    Schedule decide(const PhaseSegment& interval) {
        const auto& policy = *known_.adaptive;
        PlanStart start{planned_.start_s[interval.phase] + interval.start_s,
                        charge_.soc_percent,
                        running_,
                        running_for_s_,
                        learned_.factor(policy),
                        charge_.rc_voltage_v};
        const double seen =
            policy.learning_time_s > 0.0 ? policy.learning_time_s / (learned_.time_s + policy.learning_time_s) : 0.0;
        const double to_come = policy.learning_time_s / (planned_.duration_s - start.time_s);
        const double margin = reach_ * std::sqrt(seen + to_come);  // of the mechanical power that is left
        double reserve_percent = known_.reserve_soc_percent;
        if (state_counts())
            start.mechanical_factor += margin;  // its voltage falls as well
        else
            reserve_percent += margin * rest_mechanical_percent_;
        const auto plan =
            plan_rest(known_, adaptive_.planner, start, reserve_percent,
                      effort_for(adaptive_.planner, (planned_.duration_s - start.time_s) / known_.plan.slot_s));
        ++flight_.decisions.made;
        if (!plan.feasible) ++flight_.decisions.without_plan;
        if (!plan.schedule.empty()) return plan.schedule;
        // Nothing that the battery can deliver is known: fly on with what demands least energy.
        auto rest = minimum_energy_schedule(known_);
        std::erase_if(rest, [&](const ScheduleSegment& s) {
            return s.phase < interval.phase || (s.phase == interval.phase && s.end_s <= interval.start_s);
        });
        if (!rest.empty()) rest.front().start_s = std::max(rest.front().start_s, interval.start_s);
        return rest;
    }

    /// Runs a segment of the plan in the flight as it is.
    void fly(const ScheduleSegment& planned) {
        if (!running_ || *running_ != planned.run) running_for_s_ = 0.0;
        running_for_s_ += planned.duration_s();
        running_ = planned.run;
        append_merged(flight_.schedule, planned);
        const auto flown = rescale_to_flown_durations({planned}, known_.duration_s, actual_.duration_s);
        for (const auto& segment : disturbed(smooth_parts(load_segment(load_, flown.front())), disturbances_))
            charge_ = after_segment(battery_, actual_.cutoff_voltage_v, segment, charge_);
    }

    void learn(const PhaseSegment& interval, double observed_percent, const PredictedDepletion& predicted) {
        if (!state_counts())
            rest_mechanical_percent_ = std::max(0.0, rest_mechanical_percent_ - predicted.mechanical_percent);
        if (observed_percent < 0.0 || observed_percent > jump_factor * predicted.percent) return;
        learned_.time_s += interval.duration_s();
        learned_.observed_percent += observed_percent;
        learned_.predicted_percent += predicted.percent;
        learned_.mechanical_percent += predicted.mechanical_percent;
    }

    const AdaptivePlanner& adaptive_;
    const PlanningProblem& known_;
    const MissionSetup& actual_;
    const Disturbances& disturbances_;
    battery::Battery battery_;  ///< as it really is
    MissionTimeline planned_;
    MissionLoad known_load_;
    MissionLoad load_;  ///< of the mission as it really is
    AdaptiveFlight flight_;
    battery::Discharge charge_;
    Learned learned_;
    std::optional<compute::Configuration> running_;
    double running_for_s_ = 0.0;
    double reach_ = 0.0;                    ///< what the reserve is kept against, as a part of mechanical power
    double rest_mechanical_percent_ = 0.0;  ///< of tables
};

}  // namespace

AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem) {
    if (!problem.adaptive) throw std::invalid_argument("make_adaptive_planner: the policy is not adaptive");
    require_few_decisions(problem);
    AdaptivePlanner planner{problem, make_planner(problem)};
    if (auto& step_s = planner.planner.step_s) {
        double quick_s = 2.0;  // what that is off is far below what flights differ by
        if (problem.battery.thevenin) quick_s = std::min(quick_s, problem.battery.thevenin->rc_time_constant_s / 2.0);
        step_s = std::max(*step_s, quick_s);
    }
    return planner;
}

AdaptiveFlight fly_adaptively(const AdaptivePlanner& planner, const MissionSetup& actual,
                              const Disturbances& disturbances) {
    Flight flight(planner, actual, disturbances);
    for (const auto& interval : intervals_of(planner.known)) flight.fly(interval);
    return flight.landed();
}

}  // namespace flightwatt::mission
