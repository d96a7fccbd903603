#include "mission/infeasibility_report.h"

#include "helpers/paper_missions.h"
#include "mission/planning/planner.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// The paper's mission that is to be planned, with another reserve, for any cruise.
MissionOfCruise paper_plan(double reserve_soc_percent) {
    return [=](double cruise_s) {
        auto problem =
            std::get<PlanningProblem>(read_mission(test::paper_mission_path("plan"), {true, cruise_s}));
        problem.reserve_soc_percent = reserve_soc_percent;
        return problem;
    };
}

double final_soc(const Mission& mission) { return simulate(mission).summary.final_soc_percent.value_or(0.0); }

TEST(InfeasibilityReport, NamesWhatWouldDo) {
    const auto mission_of = paper_plan(9.0);
    const auto mission = std::get<PlanningProblem>(mission_of(600.0));
    const auto plan = plan_mission(mission);
    ASSERT_FALSE(plan.plan.feasible);
    const auto report = infeasibility_report(mission, plan, mission_of);
    EXPECT_NEAR(report.short_percent, 9.0 - 7.4306, 1e-4);
    EXPECT_NEAR(report.short_wh, report.short_percent / 100.0 * 3.416 * 3.2, 1e-9);

    ASSERT_TRUE(report.cruise_s && report.fixed_spare_percent && report.reserve_soc_percent &&
                report.capacity_ah);
    EXPECT_TRUE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s))).plan.feasible);
    EXPECT_FALSE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s + 0.1))).plan.feasible);
    auto other = mission;
    other.fixed.clear();
    EXPECT_NEAR(final_soc(with_minimum_energy_schedule(other)), 9.0 + *report.fixed_spare_percent, 1e-6);
    for (const double step : {-1e-6, 1e-6}) {
        other = mission;
        other.reserve_soc_percent = *report.reserve_soc_percent + step;
        EXPECT_EQ(plan_mission(other).plan.feasible, step < 0.0);
        other = mission;
        other.battery.capacity_ah = *report.capacity_ah - step;
        EXPECT_EQ(plan_mission(other).plan.feasible, step < 0.0);
    }
}

TEST(InfeasibilityReport, NamesNothingThatIsNotEnough) {
    const auto mission_of = paper_plan(90.0);
    const auto mission = std::get<PlanningProblem>(mission_of(600.0));
    const auto report = infeasibility_report(mission, plan_mission(mission), mission_of);
    EXPECT_FALSE(report.cruise_s);
    EXPECT_FALSE(report.fixed_spare_percent);
    EXPECT_TRUE(report.reserve_soc_percent);
}

}  // namespace
}  // namespace flightwatt::mission
