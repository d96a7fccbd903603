// What plan prints as JSON.

#include "cli/output/plan_json.h"

#include "helpers/paper_missions.h"
#include "mission/plan.h"

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TEST(PlanJson, HoldsUtilityAndProvenBound) {
    const auto problem = test::paper_problem("plan");
    const auto plan = plan_mission(problem);
    const auto json = to_json(plan, problem);
    EXPECT_TRUE(json["feasible"].get<bool>());
    EXPECT_EQ(json["utility"], *plan.summary.utility);
    EXPECT_GE(json["bound"].get<double>(), json["utility"].get<double>());
    EXPECT_EQ(json["reserve_soc_percent"], problem.reserve_soc_percent);
}

TEST(PlanJson, HasNullForWhatAnInfeasiblePlanLacks) {
    auto problem = test::paper_problem("plan");
    problem.reserve_soc_percent = 60.0;
    const auto json = to_json(plan_mission(problem), problem);
    EXPECT_FALSE(json["feasible"].get<bool>());
    EXPECT_TRUE(json["utility"].is_null());
    EXPECT_TRUE(json["bound"].is_null());
}

TEST(InfeasibilityJson, HasNullForMeasuresThatAreNotEnough) {
    mission::InfeasibilityReport report;
    report.short_percent = 2.5;
    report.capacity_ah = 4.0;
    const auto json = to_json(report);
    EXPECT_EQ(json["short_percent"], 2.5);
    EXPECT_EQ(json["smallest_capacity_ah"], 4.0);
    EXPECT_TRUE(json["longest_cruise_s"].is_null());
}

}  // namespace
}  // namespace flightwatt::cli
