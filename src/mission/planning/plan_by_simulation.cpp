#include "mission/planning/plan_by_simulation.h"

#include "mission/flown_schedule.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>

namespace flightwatt::mission {
namespace {

constexpr int most_rounds = 16;
constexpr double gap_that_is_none = 1e-5;

/// A schedule, simulated.
struct Trial {
    Mission flown;
    MissionSummary summary;
    double missing_percent = 0.0;

    bool lands() const { return summary.feasible && missing_percent <= 0.0; }
};

Trial fly(Mission flown) {
    Trial trial{std::move(flown), {}, 0.0};
    trial.summary = simulate(trial.flown).summary;
    trial.missing_percent = missing_percent(trial.flown, trial.summary, trial.flown.reserve_soc_percent);
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
            percent_ += trial.missing_percent;
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

PlanStart begin_of(const Mission& mission) { return {0.0, mission.initial_soc_percent, std::nullopt, 0.0}; }

/// No schedule that lands is worth more. Errors of the table are given away twice a slot.
double proven_bound(const Mission& mission, const Planner& highest) {
    const double slack_percent =
        2.0 * static_cast<double>(slots_of(mission).size()) * highest.drains.error_percent;
    return plan_rest(mission, highest, begin_of(mission), mission.reserve_soc_percent - slack_percent).bound;
}

/// The best trial of some rounds; `planner` is along its voltage afterwards.
Trial best_trial(const Mission& mission, const Trial& least, double bound, Planner& planner) {
    Trial best = least;
    const auto highest = planner;
    PlannedReserve reserve(mission.reserve_soc_percent, *least.summary.final_soc_percent);
    std::vector<Stretch> last;
    for (int round = 0; round < most_rounds; ++round) {
        const auto plan = plan_rest(mission, planner, begin_of(mission), reserve.percent());
        if (!plan.feasible) {
            if (!plan.deliverable) planner = highest;
            reserve.ask_for_less();
            continue;
        }
        const auto trial = fly(with_schedule(mission, plan.schedule));
        if (is_better(trial, best)) best = trial;
        if (best.summary.utility.value_or(0.0) >= bound * (1.0 - gap_that_is_none)) break;
        if (trial.lands() && trial.flown.schedule == last) break;
        last = trial.flown.schedule;
        reserve.learn(trial, plan.final_soc_percent);
        if (const auto source = source_voltage_of(trial.flown)) planner = along(mission, planner, *source);
    }
    if (const auto source = source_voltage_of(best.flown)) planner = along(mission, planner, *source);
    return best;
}

/// The plan of a mission whose flights do not differ.
MissionPlan plan_certain(const Mission& mission) {
    MissionPlan result;
    result.planner = make_planner(mission);
    auto& plan = result.plan;
    plan.bound_is_proven = !(mission.battery.thevenin && result.planner.drains.charges);
    auto found = fly(with_least_schedule(mission));
    plan.deliverable = !found.summary.undeliverable;
    plan.feasible = found.lands();
    if (plan.feasible) {
        plan.bound = proven_bound(mission, result.planner);
        found = best_trial(mission, found, plan.bound, result.planner);
        plan.utility = found.summary.utility.value_or(0.0);
        plan.bound = std::max(plan.bound, plan.utility);
    }
    plan.schedule = found.flown.schedule;
    plan.final_soc_percent = mission.reserve_soc_percent - found.missing_percent;
    result.flown = std::move(found.flown);
    result.summary = std::move(found.summary);
    return result;
}

}  // namespace

Mission unlucky_mission(const Mission& mission, double probability) {
    if (!(probability >= 0.5 && probability < 1.0)) {
        throw std::invalid_argument("unlucky_mission: the probability is not from 0.5 to below 1");
    }
    const double quantile = boost::math::quantile(boost::math::normal_distribution<double>(), probability);
    flight::PerPhase<double> sd_w;
    double energy_variance_j2 = 0.0;
    for (const auto phase : flight::all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        sd_w[phase] = level_sd_w(mission, phase);
        energy_variance_j2 += std::pow(sd_w[phase] * mission.duration_s[phase], 2);
    }
    auto unlucky = mission;
    if (energy_variance_j2 == 0.0) return unlucky;
    for (const auto phase : flight::all_phases) {
        const double part = sd_w[phase] * mission.duration_s[phase] / std::sqrt(energy_variance_j2);
        if (part > 0.0) unlucky.mechanical->phases[phase].fourier.a0_w += quantile * part * sd_w[phase];
    }
    return unlucky;
}

MissionPlan plan_by_simulation(const Mission& mission, const std::optional<double>& probability) {
    if (!probability) return plan_certain(mission);
    auto result = plan_certain(unlucky_mission(mission, *probability));
    const auto unlucky = std::move(result.summary);
    result.flown = with_schedule(mission, std::move(result.flown.schedule));
    result.summary = simulate(result.flown).summary;
    if (unlucky.final_soc_percent && result.summary.final_soc_percent) {
        result.margin_percent = *result.summary.final_soc_percent - *unlucky.final_soc_percent;
        result.plan.final_soc_percent += result.margin_percent;
    }
    if (const auto source = source_voltage_of(result.flown))
        result.planner = along(mission, std::move(result.planner), *source);
    return result;
}

}  // namespace flightwatt::mission
