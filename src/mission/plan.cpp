#include "mission/plan.h"

#include "base/units.h"
#include "mission/planning/margin_search.h"
#include "mission/planning/planner.h"
#include "mission/sampled_flights.h"
#include "mission/sampling/landing_quantile.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace flightwatt::mission {
namespace {

constexpr int max_reserve_rounds = 20;
constexpr int max_simulation_rounds = 16;
constexpr double gap_that_is_none = 1e-5;
constexpr int max_margin_rounds = 8;
constexpr double slack_part = 2e-3;  // of the flights' deviation: 0.0002 of a chance of 0.05

/// How far below `wanted_percent` a simulated mission ends [points], counting what it demanded after the
/// battery ended as a part of what a full one holds. Negative if there is more.
double reserve_deficit_percent(const MissionSetup& mission, const MissionSummary& summary, double wanted_percent) {
    const double deficit = wanted_percent - summary.final_soc_percent.value_or(0.0);
    if (summary.feasible) return deficit;
    // What is left after a cut-off cannot be drawn: it does not make up for what was demanded later.
    return std::max(deficit, 0.0) +
           units::percent_of(summary.energy_wh - summary.delivered_energy_wh, full_energy_wh(mission.battery));
}

/// A schedule, simulated.
struct Trial {
    Schedule schedule;
    MissionSummary summary;
    double deficit_percent = 0.0;

    bool lands() const { return summary.feasible && deficit_percent <= 0.0; }
};

Trial fly(const PlanningProblem& problem, Schedule schedule) {
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
    const double slack_percent = 2.0 * static_cast<double>(slots_of(problem).size()) * highest.depletions.error_percent;
    return plan_rest(problem, highest, start_of(problem), problem.reserve_soc_percent - slack_percent).bound;
}

/// The best trial of some rounds.
Trial best_trial(const PlanningProblem& problem, const Trial& least, double bound, const Planner& highest) {
    Trial best = least;
    auto planner = highest;
    PlannedReserve reserve(problem.reserve_soc_percent, *least.summary.final_soc_percent);
    Schedule last;
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
            planner = with_voltage_course(problem, planner, &*course);
    }
    return best;
}

/// For a battery whose source follows its charge, or that may be cut off: the depletion by a slot then depends on what
/// ran before it. Tables are made along the voltage of the last plan simulated, until a plan lands and the next is no
/// better; the bound is that of the highest voltage that any schedule keeps. If the schedule of least energy demand
/// does not land, none does, as it keeps the most charge and the highest voltage at any time.
MissionPlan plan_by_simulation(const PlanningProblem& problem) {
    const auto planner = make_planner(problem);
    MissionPlan result;
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
    result.flown = {problem, plan.schedule};
    return result;
}

/// Plans by tables, anew with more to spare where the simulation ends below the reserve.
MissionPlan plan_by_tables(const PlanningProblem& problem) {
    MissionPlan result;
    const auto planner = make_planner(problem);
    const auto start = start_of(problem);
    double planned_percent = problem.reserve_soc_percent;
    std::optional<double> bound;
    Schedule schedule;
    bool lands = false;
    for (int round = 0; round < max_reserve_rounds && !lands; ++round) {
        result.plan = plan_rest(problem, planner, start, planned_percent);
        if (!bound) bound = result.plan.bound;
        result.plan.bound = result.plan.feasible ? *bound : 0.0;
        schedule = result.plan.deliverable ? result.plan.schedule : minimum_energy_schedule(problem);
        result.summary = simulate(problem, schedule).summary;
        if (!result.plan.feasible) break;
        const double deficit_percent = reserve_deficit_percent(problem, result.summary, problem.reserve_soc_percent);
        lands = result.summary.feasible && deficit_percent <= 0.0;
        planned_percent += std::max(deficit_percent, 0.0) + 1e-12;
    }
    result.plan.feasible = lands;  // where it is not: none was found, which is not to say that there is none
    result.flown = {problem, std::move(schedule)};
    return result;
}

/// The plan of a mission whose flights do not differ.
MissionPlan plan_certain(const PlanningProblem& problem) {
    const bool by_simulation = problem.battery.thevenin || problem.cutoff_voltage_v > 0.0;
    return by_simulation ? plan_by_simulation(problem) : plan_by_tables(problem);
}

/// The schedule of least energy demand as a plan.
MissionPlan least_plan(const PlanningProblem& problem, const FlightSpreads& spreads, double probability) {
    MissionPlan plan;
    plan.flown = with_minimum_energy_schedule(problem);
    plan.summary = simulate(plan.flown).summary;
    plan.plan.schedule = plan.flown.schedule;
    plan.plan.deliverable = !plan.summary.undeliverable;
    const auto quantile = landing_quantile(plan.flown, spreads, probability);
    plan.margin_percent = quantile.margin_percent;
    plan.plan.final_soc_percent = quantile.left_percent + quantile.margin_percent;
    plan.plan.feasible =
        plan.summary.keeps_reserve && landing_chance(plan.flown, spreads, probability).below <= 1.0 - probability;
    plan.plan.utility = plan.plan.bound = plan.summary.utility.value_or(0.0);
    return plan;
}

/// Plans with a margin above the reserve, and looks for the least with which enough of the plan's flights keep it.
MissionPlan plan_with_chance(const PlanningProblem& problem, double probability) {
    require_known_spread(problem);
    const auto spreads = find_spreads(problem);
    auto best = least_plan(problem, spreads, probability);
    best.sources = spreads.sources;
    if (!best.plan.feasible) {
        best.plan.bound = 0.0;
        return best;
    }
    MarginSearch search(best.margin_percent);
    bool is_least = true;
    LandingChance landing;
    Schedule last;
    for (int round = 0; round < max_margin_rounds && !search.is_exhausted(); ++round) {
        const double planned_percent = std::max(search.margin_percent(), 0.0);  // as stated, it keeps the reserve too
        auto stricter = problem;
        stricter.reserve_soc_percent += planned_percent;
        auto plan = plan_certain(stricter);
        if (!plan.plan.feasible) {
            search.learn_too_much();
            continue;
        }
        plan.flown.reserve_soc_percent = problem.reserve_soc_percent;
        if (plan.flown.schedule != last) landing = landing_chance(plan.flown, spreads, probability);
        last = plan.flown.schedule;
        const double slack_percent = landing.spare_percent(probability);
        const double close_percent = slack_part * landing.sd_percent;
        search.learn(slack_percent, close_percent / 2.0);
        if (slack_percent < 0.0) continue;
        const bool is_same = plan.flown.schedule == best.flown.schedule;
        if (is_least || *plan.summary.utility >= *best.summary.utility) {
            plan.sources = spreads.sources;
            plan.chance_standard_error = landing.standard_error;
            best = std::move(plan);
        }
        if (slack_percent <= close_percent || planned_percent == 0.0 || (is_same && !is_least)) break;
        is_least = false;
    }
    best.summary = simulate(best.flown).summary;
    best.margin_percent = std::max(landing_quantile(best.flown, spreads, probability).margin_percent, 0.0);
    return best;
}

}  // namespace

void require_known_spread(const MissionSetup& mission) {
    if (mission.mechanical)
        require_known_levels(mission);
    else
        require_spread(mission);
}

MissionPlan plan_mission(const PlanningProblem& problem, const std::optional<double>& probability) {
    return probability ? plan_with_chance(problem, *probability) : plan_certain(problem);
}

MissionSummary labelled_summary(const MissionPlan& plan) {
    constexpr double as_good_as_optimal = 1e-3;
    auto summary = plan.summary;
    const double utility = summary.utility.value_or(0.0);
    const bool optimal = plan.plan.bound_is_proven && plan.plan.bound - utility <= as_good_as_optimal * plan.plan.bound;
    summary.feasible = summary.feasible && plan.plan.feasible;
    summary.schedule = !plan.plan.feasible ? ScheduleOrigin::infeasible
                       : optimal           ? ScheduleOrigin::optimal
                                           : ScheduleOrigin::planned;
    return summary;
}

}  // namespace flightwatt::mission
