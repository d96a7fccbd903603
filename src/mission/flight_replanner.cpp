#include "mission/flight_replanner.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "mission/planning/planner.h"
#include "mission/planning/survey_layouts.h"
#include "mission/sampling/flight_spreads.h"
#include "mission/sampling/joint_spread.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

void require_few_decisions(const PlanningProblem& known) {
    constexpr double most = 20000.0;
    const double decisions = timeline_of(known.setup.duration_s).duration_s / known.adaptive->decide_every_s;
    if (decisions <= most) return;
    throw InputError({known.setup.file},
                     fmt::format("a plan every {:.6g} s makes {:.3g} plans, more than {:.0f}",
                                 known.adaptive->decide_every_s, decisions, most),
                     "make decide_every_s in [policy] longer");
}

/// Returns few states to follow over a long time; more near the end, where what is left is spent.
SearchLimits effort_for(double slots_left) {
    constexpr double searched_slots = 8.0;
    return {1e-4, slots_left <= searched_slots ? std::size_t{200} : std::size_t{5}, 4};
}

/// Quantile of the relative deviation of mechanical power from the model's at the policy's probability: by the policy's
/// standard deviation, by that of flights (independent between phases), or by 5 %.
double expected_reach(const PlanningProblem& mission) {
    constexpr double sd_if_unknown_percent = 5.0;
    const auto& policy = *mission.adaptive;
    if (policy.mechanical_sd_percent || !has_flight_variability(mission.setup)) {
        const double sd_percent = policy.mechanical_sd_percent.value_or(sd_if_unknown_percent);
        return sd_percent / units::percent_per_whole * normal_quantile(policy.probability);
    }
    double energy = 0.0;
    double variance = 0.0;
    double freedom = infinite_dof;
    for (const auto phase : all_phases) {
        const double duration_s = mission.setup.duration_s[phase];
        if (!(duration_s > 0.0)) continue;
        const auto deviation = level_deviation(mission.setup, phase);
        energy += mean_level_w(mission.setup, phase) * duration_s;
        variance += std::pow(deviation.sd_w * duration_s, 2);
        freedom = std::min(freedom, deviation.degrees_of_freedom);
    }
    const double deviations = student_from_normal(normal_quantile(policy.probability), freedom);
    return energy > 0.0 ? deviations * std::sqrt(variance) / energy : 0.0;
}

constexpr double jump_factor = 2.0;  ///< of the depletion predicted: beyond, charge was lost otherwise

}  // namespace

AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem) {
    if (!problem.adaptive) throw std::invalid_argument("make_adaptive_planner: the policy is not adaptive");
    require_few_decisions(problem);
    return {problem, std::make_shared<const PlanningTables>(make_planning_tables(problem))};
}

FlightReplanner::FlightReplanner(const AdaptivePlanner& planner)
    : adaptive_(planner), required_deviation_(expected_reach(planner.nominal)) {
    use({std::shared_ptr<void>(), &planner.nominal});
}

void FlightReplanner::use(std::shared_ptr<const PlanningProblem> problem) {
    problem_ = std::move(problem);
    planned_ = timeline_of(problem_->setup.duration_s);
    known_load_ = std::make_shared<const MissionLoad>(make_mission_load(problem_->setup));
}

double FlightReplanner::mechanical_factor() const {
    if (observed_.mechanical_percent <= 0.0) return 1.0;
    const double gain = observed_.time_s / (observed_.time_s + adaptive_.nominal.adaptive->learning_time_s);
    return std::max(
        0.0, 1.0 + gain * (observed_.observed_percent - observed_.predicted_percent) / observed_.mechanical_percent);
}

FlightReplanner::PredictedDepletion FlightReplanner::predict(const Schedule& run,
                                                             const battery::BatteryState& state) const {
    constexpr double more = 0.01;
    const auto lost_percent = [&](double mechanical_factor) {
        Disturbance wind;
        wind.mechanical_factor = mechanical_factor;
        battery::Discharge now{state};
        for (const auto& scheduled : run)
            for (const auto& segment : disturbed(load_segments(*known_load_, scheduled), {wind}))
                now = advance_segment(problem_->setup.battery, 0.0, segment, now);
        return state.soc_percent - now.soc_percent;
    };
    const double percent = lost_percent(1.0);
    return {percent, (lost_percent(1.0 + more) - percent) / more};
}

Plan FlightReplanner::replan(const PhaseTime& moment, const battery::BatteryState& now) {
    const double time_s = planned_.start_s[moment.phase] + moment.time_s;
    auto best = plan_from(*problem_, time_s, now);
    const auto& choices = adaptive_.nominal.survey;
    if (!choices || moment.phase == Phase::landing) return best;
    const auto merit = [&](const PlanningProblem& problem, const Plan& plan) {
        const double duration_s = timeline_of(problem.setup.duration_s).duration_s;
        const double utility = (utility_ + plan.utility * (duration_s - time_s)) / duration_s;
        return std::tuple(plan.feasible,
                          plan.feasible ? utility + coverage_utility(problem.setup) : plan.final_soc_percent,
                          plan.feasible ? 0.0 : -duration_s * mean_level_w(problem.setup, Phase::cruise));
    };
    auto most = merit(*problem_, best);
    std::optional<PlanningProblem> chosen;
    const double cruise_s = moment.phase == Phase::cruise ? moment.time_s : 0.0;
    for (const auto& layout : remaining_layouts(*choices, *problem_->setup.survey, cruise_s)) {
        try {
            auto problem = choices->mission_with(layout);
            auto plan = plan_from(problem, time_s, now);
            const auto reached = merit(problem, plan);
            if (reached <= most) continue;
            most = reached;
            best = std::move(plan);
            chosen = std::move(problem);
        } catch (const InputError&) {  // its path cannot be flown
            continue;
        }
    }
    if (chosen) use(std::make_shared<const PlanningProblem>(std::move(*chosen)));
    return best;
}

Plan FlightReplanner::plan_from(const PlanningProblem& problem, double time_s, const battery::BatteryState& now) const {
    const auto& policy = *adaptive_.nominal.adaptive;
    const double left_s = timeline_of(problem.setup.duration_s).duration_s - time_s;
    const double seen =
        policy.learning_time_s > 0.0 ? policy.learning_time_s / (observed_.time_s + policy.learning_time_s) : 0.0;
    const double margin = required_deviation_ * std::sqrt(seen + policy.learning_time_s / left_s);
    const PlanStart start{time_s,          now.soc_percent, running_, running_for_s_, mechanical_factor() + margin,
                          now.rc_voltage_v};
    return plan_remaining(problem, *adaptive_.planner, start, problem.setup.reserve_soc_percent,
                          effort_for(left_s / problem.plan.slot_s));
}

void FlightReplanner::update(const PhaseSegment& interval, const Schedule& run, const battery::BatteryState& before,
                             double soc_after_percent) {
    for (const auto& segment : run) {
        if (!running_ || *running_ != segment.run) running_for_s_ = 0.0;
        running_for_s_ += segment.duration_s();
        utility_ += utility_per_s(problem_->setup.utilities, segment.run) * segment.duration_s();
        running_ = segment.run;
    }
    const auto predicted = predict(run, before);
    const double observed_percent = before.soc_percent - soc_after_percent;
    if (observed_percent < 0.0 || observed_percent > jump_factor * predicted.percent) return;
    observed_.time_s += interval.duration_s();
    observed_.observed_percent += observed_percent;
    observed_.predicted_percent += predicted.percent;
    observed_.mechanical_percent += predicted.mechanical_percent;
}

Schedule clip_to_interval(const Schedule& plan, const PhaseSegment& interval) {
    Schedule run;
    for (const auto& planned : plan) {
        if (planned.phase != interval.phase || planned.start_s >= interval.end_s) {
            if (run.empty() && planned.phase <= interval.phase) continue;
            break;
        }
        if (planned.end_s <= interval.start_s) continue;
        run.push_back(planned);
        run.back().start_s = std::max(planned.start_s, interval.start_s);
        run.back().end_s = std::min(planned.end_s, interval.end_s);
    }
    return run;
}

}  // namespace flightwatt::mission
