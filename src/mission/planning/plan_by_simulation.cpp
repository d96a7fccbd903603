#include "mission/planning/plan_by_simulation.h"

#include "base/statistics.h"
#include "mission/planning/plan_rest.h"
#include "mission/planning/reserve_deficit.h"
#include "mission/planning/voltage_course.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace flightwatt::mission {
namespace {

constexpr int max_simulation_rounds = 16;
constexpr double gap_that_is_none = 1e-5;

/// A schedule, simulated.
struct Trial {
    std::vector<ScheduleSegment> schedule;
    MissionSummary summary;
    double deficit_percent = 0.0;

    bool lands() const { return summary.feasible && deficit_percent <= 0.0; }
};

Trial fly(const PlanningProblem& problem, std::vector<ScheduleSegment> schedule) {
    Trial trial{std::move(schedule), {}, 0.0};
    trial.summary = simulate(problem, trial.schedule).summary;
    trial.deficit_percent = reserve_deficit_percent(problem, trial.summary, problem.reserve_soc_percent);
    return trial;
}

bool is_better(const Trial& a, const Trial& b) {
    return a.lands() && a.summary.utility.value_or(0.0) > b.summary.utility.value_or(0.0);
}

/// How much to plan for, by what the plans before came to.
class PlannedReserve {
  public:
    PlannedReserve(double wanted_percent, double most_percent)
        : wanted_percent_(wanted_percent), most_percent_(most_percent), percent_(wanted_percent) {}

    double percent() const { return percent_; }

    /// `tabled_percent` is what the table said that the trial would leave.
    void learn(const Trial& trial, double tabled_percent) {
        if (trial.summary.feasible) {
            // The table's error at this schedule is about that at the next.
            const double error_percent = tabled_percent - *trial.summary.final_soc_percent;
            percent_ = wanted_percent_ + error_percent + rounding_percent;
            if (trial.lands()) most_percent_ = std::min(most_percent_, std::max(percent_, tabled_percent));
        } else if (trial.summary.cut_off_at_s) {
            too_low_percent_ = std::max(percent_, too_low_percent_);
            percent_ = std::midpoint(too_low_percent_, std::max(most_percent_, too_low_percent_));
        } else {
            percent_ += trial.deficit_percent;
        }
        percent_ = std::max(percent_, too_low_percent_);
    }

    /// The table knows no plan with so much.
    void ask_for_less() { percent_ = std::midpoint(percent_, std::max(wanted_percent_, too_low_percent_)); }

  private:
    static constexpr double rounding_percent = 1e-9;
    double wanted_percent_;
    double most_percent_;  ///< with it a plan landed
    double percent_;
    double too_low_percent_ = 0.0;  ///< with it a plan was cut off
};

PlanStart start_of(const PlanningProblem& problem) { return {0.0, problem.initial_soc_percent}; }

/// No schedule that lands has more utility. Errors of the table are given away twice a slot.
double proven_bound(const PlanningProblem& problem, const Planner& highest) {
    const double slack_percent =
        2.0 * static_cast<double>(slots_of(problem).size()) * highest.depletions.error_percent;
    return plan_rest(problem, highest, start_of(problem), problem.reserve_soc_percent - slack_percent).bound;
}

/// The best trial of some rounds.
Trial best_trial(const PlanningProblem& problem, const Trial& least, double bound, const Planner& highest) {
    Trial best = least;
    auto planner = highest;
    PlannedReserve reserve(problem.reserve_soc_percent, *least.summary.final_soc_percent);
    std::vector<ScheduleSegment> last;
    for (int round = 0; round < max_simulation_rounds; ++round) {
        const auto plan = plan_rest(problem, planner, start_of(problem), reserve.percent());
        if (!plan.feasible) {
            if (!plan.deliverable) planner = highest;
            reserve.ask_for_less();
            continue;
        }
        const auto trial = fly(problem, plan.schedule);
        if (is_better(trial, best)) best = trial;
        if (best.summary.utility.value_or(0.0) >= bound * (1.0 - gap_that_is_none)) break;
        if (trial.lands() && trial.schedule == last) break;
        last = trial.schedule;
        reserve.learn(trial, plan.final_soc_percent);
        if (const auto course = voltage_course_of(problem, trial.schedule))
            planner = with_voltage_course(problem, planner, *course);
    }
    return best;
}

/// A plan, its bound and how it ends.
struct TrialPlan {
    Plan plan;
    MissionSummary summary;
};

/// The plan of a mission whose flights do not differ.
TrialPlan plan_certain(const PlanningProblem& problem) {
    const auto planner = make_planner(problem);
    TrialPlan result;
    auto& plan = result.plan;
    plan.bound_is_proven = !(problem.battery.thevenin && planner.depletions.charges);
    auto found = fly(problem, minimum_energy_schedule(problem));
    plan.deliverable = !found.summary.undeliverable;
    plan.feasible = found.lands();
    if (plan.feasible) {
        plan.bound = proven_bound(problem, planner);
        found = best_trial(problem, found, plan.bound, planner);
        plan.utility = found.summary.utility.value_or(0.0);
        plan.bound = std::max(plan.bound, plan.utility);
    }
    plan.schedule = std::move(found.schedule);
    plan.final_soc_percent = problem.reserve_soc_percent - found.deficit_percent;
    result.summary = std::move(found.summary);
    return result;
}

}  // namespace

PlanningProblem mission_at_quantile(const PlanningProblem& problem, double probability) {
    if (!(probability >= 0.5 && probability < 1.0)) {
        throw std::invalid_argument("mission_at_quantile: the probability is not from 0.5 to below 1");
    }
    flight::PerPhase<double> sd_w;
    double energy_variance_j2 = 0.0;
    for (const auto phase : flight::all_phases) {
        if (problem.duration_s[phase] == 0.0) continue;
        sd_w[phase] = level_sd_w(problem, phase);
        energy_variance_j2 += std::pow(sd_w[phase] * problem.duration_s[phase], 2);
    }
    auto stronger = problem;
    if (energy_variance_j2 == 0.0) return stronger;
    for (const auto phase : flight::all_phases) {
        const double part = sd_w[phase] * problem.duration_s[phase] / std::sqrt(energy_variance_j2);
        if (part > 0.0) {
            stronger.mechanical->phases[phase].fourier.a0_w +=
                normal_quantile(probability) * part * sd_w[phase];
        }
    }
    return stronger;
}

MissionPlan plan_by_simulation(const PlanningProblem& problem, const std::optional<double>& probability) {
    auto [plan, summary] = plan_certain(probability ? mission_at_quantile(problem, *probability) : problem);
    MissionPlan result{std::move(plan), {problem, {}}, std::move(summary), 0.0};
    result.flown.schedule = result.plan.schedule;
    if (!probability) return result;
    const auto at_quantile = std::move(result.summary);
    result.summary = simulate(result.flown).summary;
    if (at_quantile.final_soc_percent && result.summary.final_soc_percent) {
        result.margin_percent = *result.summary.final_soc_percent - *at_quantile.final_soc_percent;
        result.plan.final_soc_percent += result.margin_percent;
    }
    return result;
}

}  // namespace flightwatt::mission
