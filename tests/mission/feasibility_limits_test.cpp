#include "mission/feasibility_limits.h"

#include "helpers/paper_missions.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// A mission of the paper's, with another battery and reserve, for any cruise.
MissionForCruise paper(const std::string& name, double resistance_ohm, double reserve_soc_percent) {
    const auto path = test::paper_mission_path(name);
    return [=](double cruise_s) {
        auto mission = read_mission(path, {true, cruise_s});
        std::visit(
            [&](MissionSetup& setup) {
                if (resistance_ohm > 0.0) setup.battery = {"", 3.6, resistance_ohm, 3.4};
                setup.reserve_soc_percent = reserve_soc_percent;
            },
            mission);
        return mission;
    };
}

double final_soc(const Mission& mission) { return simulate(mission).summary.final_soc_percent.value_or(0.0); }

TEST(LongestCruise, EndsOnTheReserve) {
    for (const auto* name : {"phased", "plan"}) {
        for (const double resistance_ohm : {0.0, 0.01}) {
            for (const double reserve : {0.5, 6.0, 30.0}) {
                const auto mission_of = paper(name, resistance_ohm, reserve);
                const auto most = longest_cruise(mission_of);
                EXPECT_NEAR(final_soc(with_minimum_energy_schedule(mission_of(most.value))), reserve, 1e-6);
                EXPECT_NEAR(most.residual_percent, 0.0, 1e-6) << name;
                EXPECT_EQ(most.limited_by, LimitingFactor::charge);
                EXPECT_LT(final_soc(with_minimum_energy_schedule(mission_of(most.value + 0.1))), reserve);
            }
        }
    }
}

TEST(LongestCruise, HasNoAnswerWhereTheScheduleDoesNotFit) {
    // The fixed two minutes and the other phases alone cost more than 80 points would leave.
    EXPECT_THROW(longest_cruise(paper("plan", 0.0, 85.0)), NoResultError);
}

TEST(LargestPayload, EndsOnTheReserve) {
    for (const auto* name : {"phased", "plan"}) {
        for (const double resistance_ohm : {0.0, 0.01}) {
            const auto mission = paper(name, resistance_ohm, 0.5)(600.0);
            const auto most = largest_payload(mission);
            EXPECT_GT(most.value, 0.1);
            EXPECT_NEAR(most.residual_percent, 0.0, 1e-6);
            const auto bare = with_minimum_energy_schedule(mission);
            EXPECT_NEAR(final_soc(with_payload(bare, most.value)), 0.5, 1e-6);
            EXPECT_LT(final_soc(with_payload(bare, most.value + 0.01)), 0.5);
        }
    }
}

TEST(LargestPayload, EndsWhereTheBatteryCannotDeliver) {
    auto mission = std::get<Mission>(paper("mechanical-only", 0.0, 0.0)(600.0));
    mission.battery = {"", 11.1, 0.5, 100.0};  // charge enough, but 61.605 W at most
    const auto most = largest_payload(mission);
    EXPECT_EQ(most.limited_by, LimitingFactor::power);
    EXPECT_GT(most.residual_percent, 10.0);
    EXPECT_FALSE(simulate(with_payload(mission, most.value - 1e-3)).summary.undeliverable);
    EXPECT_TRUE(simulate(with_payload(mission, most.value + 1e-3)).summary.undeliverable);
}

TEST(LargestPayload, HasNoAnswerWhereTheMissionDoesNotLandAsItIs) {
    EXPECT_THROW(largest_payload(paper("phased", 0.0, 5.0)(600.0)), NoResultError);
}

/// The paper's mission that is to be planned, with another reserve, for any cruise.
MissionForCruise paper_plan(double reserve_soc_percent) {
    return [=](double cruise_s) {
        auto problem = std::get<PlanningProblem>(read_mission(test::paper_mission_path("plan"), {true, cruise_s}));
        problem.reserve_soc_percent = reserve_soc_percent;
        return problem;
    };
}

TEST(InfeasibilityReport, NamesWhatWouldDo) {
    const auto mission_of = paper_plan(9.0);
    const auto mission = std::get<PlanningProblem>(mission_of(600.0));
    const auto plan = plan_mission(mission);
    ASSERT_FALSE(plan.plan.feasible);
    const auto report = infeasibility_report(mission, plan, mission_of);
    EXPECT_NEAR(report.shortfall_percent, 9.0 - 7.4306, 1e-4);
    EXPECT_NEAR(report.shortfall_wh, report.shortfall_percent / 100.0 * 3.416 * 3.2, 1e-9);

    ASSERT_TRUE(report.cruise_s && report.min_fixed_surplus_percent && report.reserve_soc_percent &&
                report.capacity_ah);
    EXPECT_TRUE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s))).plan.feasible);
    EXPECT_FALSE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s + 0.1))).plan.feasible);
    auto other = mission;
    other.fixed.clear();
    EXPECT_NEAR(final_soc(with_minimum_energy_schedule(other)), 9.0 + *report.min_fixed_surplus_percent, 1e-6);
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
    EXPECT_FALSE(report.min_fixed_surplus_percent);
    EXPECT_TRUE(report.reserve_soc_percent);
}

TEST(InfeasibilityReport, NamesTheCruiseToStateWhereItsDurationDiffers) {
    MissionSetup mission;
    mission.duration_s[flight::Phase::cruise] = 600.5;
    InfeasibilityReport report;
    report.cruise_s = 628.4;
    report.cruise_differs_now = true;
    EXPECT_THAT(describe(mission, report),
                testing::HasSubstr("do: a stated cruise of at most 10 min 28 s (duration_s = { cruise = 628.4 }"));
    report.cruise_s = 590.0;
    report.cruise_differs_now = false;
    EXPECT_THAT(describe(mission, report), testing::HasSubstr("do: a cruise 10.5 s shorter (590.0 s: 9 min 50 s)"));
}

}  // namespace
}  // namespace flightwatt::mission
