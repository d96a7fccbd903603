#include "mission/infeasibility_report.h"

#include "base/units.h"
#include "mission/planning/planner.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::optional<double> cruise_that_lands(const MissionOfCruise& mission_of, double margin_percent) {
    const auto with_margin = [&](double cruise_s) {
        auto mission = mission_of(cruise_s);
        std::visit([&](MissionSetup& setup) { setup.reserve_soc_percent += margin_percent; }, mission);
        return mission;
    };
    try {
        return longest_cruise(with_margin).value;
    } catch (const NoAnswerError&) {
        return std::nullopt;
    }
}

std::optional<double> spare_without_fixed(PlanningProblem problem, double margin_percent) {
    if (problem.fixed.empty()) return std::nullopt;
    problem.fixed.clear();
    const double spare = spare_percent(with_minimum_energy_schedule(problem)) - margin_percent;
    if (spare < 0.0) return std::nullopt;
    return spare;
}

}  // namespace

InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionOfCruise& mission_of) {
    InfeasibilityReport report;
    const double wanted = problem.reserve_soc_percent + plan.margin_percent;
    const double least_depletion = problem.initial_soc_percent - plan.plan.final_soc_percent;
    report.short_percent = wanted - plan.plan.final_soc_percent;
    report.short_wh = units::part_of(full_energy_wh(problem.battery), report.short_percent);
    report.cut_off_at_s = plan.summary.cut_off_at_s;
    report.cruise_s = cruise_that_lands(mission_of, plan.margin_percent);
    report.fixed_spare_percent = spare_without_fixed(problem, plan.margin_percent);
    const double possible = plan.plan.final_soc_percent - plan.margin_percent;
    if (possible >= 0.0 && plan.summary.feasible) report.reserve_soc_percent = possible;
    if (problem.battery.thevenin || problem.cutoff_voltage_v > 0.0) {
        auto with_margin = problem;
        with_margin.reserve_soc_percent = wanted;
        report.capacity_ah = least_capacity_ah(with_margin);
        return report;
    }
    // Depletion and margin are parts of the capacity; the reserve stays what it is.
    const double usable = problem.initial_soc_percent - problem.reserve_soc_percent;
    if (usable > 0.0) {
        report.capacity_ah = problem.battery.capacity_ah * (least_depletion + plan.margin_percent) / usable;
    }
    return report;
}

std::string describe(const MissionSetup& mission, const InfeasibilityReport& report) {
    std::vector<std::string> remedies;
    if (report.cruise_s) {
        remedies.push_back(fmt::format("a cruise {:.1f} s shorter ({:.1f} s)",
                                       mission.duration_s[flight::Phase::cruise] - *report.cruise_s,
                                       *report.cruise_s));
    }
    if (report.fixed_spare_percent) {
        remedies.push_back(
            fmt::format("lower quality where it is fixed (the least leaves {:.2f} points to spare)",
                        *report.fixed_spare_percent));
    }
    if (report.reserve_soc_percent) {
        remedies.push_back(fmt::format("a reserve of at most {:.2f} %", *report.reserve_soc_percent));
    }
    if (report.capacity_ah) {
        remedies.push_back(fmt::format("a battery of {:.3f} Ah instead of {:.3f} Ah", *report.capacity_ah,
                                       mission.battery.capacity_ah));
    }
    auto text = fmt::format(
        "no schedule lands with the reserve: the one that demands least energy is {}short by {:.2f} points "
        "({:.3f} Wh)",
        report.cut_off_at_s ? fmt::format("cut off at {:.1f} s, ", *report.cut_off_at_s) : "",
        report.short_percent, report.short_wh);
    if (!remedies.empty()) text += fmt::format("; any one of these would do: {}", fmt::join(remedies, ", "));
    return text;
}

}  // namespace flightwatt::mission
