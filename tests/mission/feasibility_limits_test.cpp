#include "mission/feasibility_limits.h"

#include "helpers/paper_missions.h"
#include "helpers/path_missions.h"
#include "mission/mission_file.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using path::Circles;
using path::FlightPath;
using path::Leg;
using path::Wind;
using test::path_element;
using test::path_mission;

/// A mission of the paper's, with another battery and reserve, for any cruise.
MissionVariation paper(const std::string& name, double resistance_ohm, double reserve_soc_percent) {
    const auto path = test::paper_mission_path(name);
    return [=](double cruise_s) {
        auto mission = read_mission(path, {true, cruise_s});
        std::visit(
            [&](auto& either) {
                if (resistance_ohm > 0.0) either.setup.battery = {"", 3.6, resistance_ohm, 3.4};
                either.setup.reserve_soc_percent = reserve_soc_percent;
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
    mission.setup.battery = {"", 11.1, 0.5, 100.0};  // charge enough, but 61.605 W at most
    const auto most = largest_payload(mission);
    EXPECT_EQ(most.limited_by, LimitingFactor::power);
    EXPECT_GT(most.residual_percent, 10.0);
    EXPECT_FALSE(simulate(with_payload(mission, most.value - 1e-3)).summary.undeliverable);
    EXPECT_TRUE(simulate(with_payload(mission, most.value + 1e-3)).summary.undeliverable);
}

TEST(LargestPayload, HasNoAnswerWhereTheMissionDoesNotLandAsItIs) {
    EXPECT_THROW(largest_payload(paper("phased", 0.0, 5.0)(600.0)), NoResultError);
}

MissionVariant with_reserve(Mission mission, double reserve_percent) {
    mission.setup.reserve_soc_percent = reserve_percent;
    return mission;
}

TEST(PathLimits, CountTheCirclesThatTheReserveAllows) {
    const auto mission_of = [](double circles) {
        return with_reserve(path_mission({{path_element(Leg{1300.0, 0.0}), path_element(Circles{100.0, circles}),
                                           path_element(Leg{1300.0, 180.0})}}),
                            30.0);
    };
    const auto most = max_circles(mission_of);
    const auto model = test::made_up_wing();
    const double tangent = 13.0 * 13.0 / (9.80665 * 100.0);
    const double circle_j = 2.0 * std::numbers::pi * 100.0 / 13.0 * (21.97 + 40.0 * tangent * tangent / 13.0);
    EXPECT_EQ(most.value, std::floor((0.7 * 36000.0 - 2.0 * 100.0 * 21.97) / circle_j));
    EXPECT_EQ(most.limited_by, LimitingFactor::charge);
    EXPECT_NEAR(most.final_soc_percent,
                simulate(std::get<Mission>(mission_of(most.value))).summary.final_soc_percent.value(), 1e-12);
    EXPECT_EQ(reach_unit_of(std::get<Mission>(mission_of(3.0)).setup), ReachUnit::circles);
    const auto too_far = [&](double circles) { return with_reserve(std::get<Mission>(mission_of(circles)), 90.0); };
    EXPECT_THROW(max_circles(too_far), NoResultError);
}

TEST(PathLimits, FindTheFarthestPlaceToReturnFrom) {
    const FlightPath path{{path_element(Leg{6000.0, 0.0}), path_element(Leg{9000.0, 90.0})}};
    const Wind wind{5.0, 0.0};
    EXPECT_EQ(reach_unit_of(path_mission(path).setup), ReachUnit::return_m);
    const auto mission_of = [&](double after_m) {
        return with_reserve(path_mission(out_and_back(path, after_m, {}), wind), 20.0);
    };
    const auto most = farthest_return(mission_of, length_of_legs_m(path));
    // 8 m/s out, 18 back, and 12 across the wind, at 21.97 W.
    const double across_s = 0.8 * 36000.0 / 21.97 - 6000.0 / 8.0 - 6000.0 / 18.0;
    EXPECT_NEAR(most.value, 6000.0 + 12.0 * across_s / 2.0, 1e-3);
    EXPECT_NEAR(most.residual_percent, 0.0, 1e-5);
    EXPECT_EQ(most.limited_by, LimitingFactor::charge);
    // From the end of a short path.
    const FlightPath near{{path_element(Leg{600.0, 0.0})}};
    const auto all = farthest_return(
        [&](double after_m) { return with_reserve(path_mission(out_and_back(near, after_m, {})), 20.0); }, 600.0);
    EXPECT_EQ(all.value, 600.0);
    EXPECT_EQ(to_string(all.limited_by), "path");
    EXPECT_THROW(farthest_return(mission_of, 0.0), NoResultError);
    // The wind forbids the way back.
    const auto downwind = [&](double after_m) {
        return with_reserve(path_mission(out_and_back(near, after_m, {}), {14.0, 180.0}), 20.0);
    };
    EXPECT_THROW(farthest_return(downwind, 600.0), InputError);
}

TEST(PathLimits, FindHowOftenThePathFits) {
    const FlightPath path{{path_element(Leg{6000.0, 0.0}), path_element(Leg{3000.0, 90.0})}};
    const auto mission_of = [&](double reserve_percent) {
        return [&path, reserve_percent](double times) {
            return with_reserve(path_mission(path::repeated(path, {}, times)), reserve_percent);
        };
    };
    const auto setup = path_mission(path).setup;
    // 21.97 W at 13 m/s, of 10 Wh; back straight to the start before the second time.
    const double flown_m = 0.5 * 36000.0 / 21.97 * 13.0;
    const double again_m = 9000.0 + std::hypot(6000.0, 3000.0);
    const auto more = most_path_times(mission_of(50.0));
    EXPECT_NEAR(more.value, 1.0 + (flown_m - 9000.0) / again_m, 1e-6);
    EXPECT_NEAR(more.residual_percent, 0.0, 1e-5);
    EXPECT_EQ(
        describe_path_times(setup, 1.25),
        "the path is flown once; 5 min 2 s of cruise remain, 25 % of another time with the way back to its start");
    const auto less = most_path_times(mission_of(80.0));
    EXPECT_NEAR(less.value, 0.2 * 36000.0 / 21.97 * 13.0 / 9000.0, 1e-6);
    EXPECT_EQ(describe_path_times(setup, 0.8),
              "80 % of the path fits: 9 min 14 s of 11 min 32 s, until element 2 of 2, leg");
    const auto there_and_back = path_mission({{path_element(Leg{600.0, 0.0}), path_element(Leg{600.0, 180.0})}});
    EXPECT_THAT(describe_path_times(there_and_back.setup, 0.5),
                testing::HasSubstr("fits with the way back from there"));
    EXPECT_THROW(most_path_times(mission_of(100.5)), NoResultError);
    auto turn = path_element(Circles{100.0, 0.5});
    turn.is_turn = true;
    EXPECT_EQ(reach_unit_of(path_mission({{path_element(Leg{600.0, 0.0}), turn}}).setup), ReachUnit::path_times);
}

TEST(PathLimits, StopBeforeAPartThatCannotBeFlown) {
    const FlightPath path{{path_element(Leg{9000.0, 0.0})}};
    const auto most = most_path_times([&](double times) {
        if (times > 0.2 && times < 0.6) throw InputError({}, "the way back is too steep");
        return with_reserve(path_mission(repeated(path, {}, times)), 80.0);
    });
    EXPECT_NEAR(most.value, 0.2, 1e-6);
}

/// Out across the wind, and then with a wind that forbids that way back.
TEST(PathLimits, StopWhereTheWindForbidsTheWayBack) {
    const FlightPath path{{path_element(Leg{600.0, 90.0}), path_element(Leg{600.0, 0.0})}};
    const Wind wind{12.9, 180.0};
    const auto most = farthest_return(
        [&](double after_m) {
            return with_reserve(
                path_mission(out_and_back(path, after_m, {}), after_m > 600.0 ? Wind{14.0, 180.0} : wind), 20.0);
        },
        length_of_legs_m(path));
    EXPECT_NEAR(most.value, 600.0, 1e-5);
    EXPECT_GT(most.final_soc_percent, 20.0);
}

TEST(PathLimits, KeepTheReserveWithAChance) {
    const auto mission_of = [](double circles) {
        auto mission = path_mission({{path_element(Circles{100.0, circles})}}, {3.0, 0.0, 1.0, 10.0});
        mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 4.0;
        return with_reserve(std::move(mission), 30.0);
    };
    const auto certain = max_circles(mission_of);
    const auto likely = max_circles(mission_of, 0.95);
    EXPECT_LT(likely.value, certain.value);
    ASSERT_TRUE(likely.sources);
    EXPECT_GT(likely.margin_percent, 0.0);
    EXPECT_GE(likely.residual_percent, -1e-6);
    const auto spare_percent = [&](double circles) {
        const auto mission = std::get<Mission>(mission_of(circles));
        return draw_landings(mission, collect_uncertainty(mission.setup)).spare_percent(0.95);
    };
    EXPECT_GE(spare_percent(likely.value), 0.0);
    EXPECT_LT(spare_percent(likely.value + 1.0), 0.0);
    // One more would not keep it: less than what the margin asks for is left.
    EXPECT_LT(likely.residual_percent, 3.0);
}

/// The paper's mission that is to be planned, with another reserve, for any cruise.
MissionVariation paper_plan(double reserve_soc_percent) {
    return [=](double cruise_s) {
        auto problem = std::get<PlanningProblem>(read_mission(test::paper_mission_path("plan"), {true, cruise_s}));
        problem.setup.reserve_soc_percent = reserve_soc_percent;
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

    ASSERT_TRUE(report.cruise_s && report.reserve_soc_percent && report.capacity_ah);
    EXPECT_TRUE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s))).plan.feasible);
    EXPECT_FALSE(plan_mission(std::get<PlanningProblem>(mission_of(*report.cruise_s + 0.1))).plan.feasible);
    auto other = mission;
    for (const double step : {-1e-6, 1e-6}) {
        other = mission;
        other.setup.reserve_soc_percent = *report.reserve_soc_percent + step;
        EXPECT_EQ(plan_mission(other).plan.feasible, step < 0.0);
        other = mission;
        other.setup.battery.capacity_ah = *report.capacity_ah - step;
        EXPECT_EQ(plan_mission(other).plan.feasible, step < 0.0);
    }
}

TEST(InfeasibilityReport, NamesNothingThatIsNotEnough) {
    const auto mission_of = paper_plan(90.0);
    const auto mission = std::get<PlanningProblem>(mission_of(600.0));
    const auto report = infeasibility_report(mission, plan_mission(mission), mission_of);
    EXPECT_FALSE(report.cruise_s);
    EXPECT_TRUE(report.reserve_soc_percent);
}

TEST(InfeasibilityReport, NamesTheCruiseToState) {
    InfeasibilityReport report;
    report.cruise_s = 628.46;
    EXPECT_THAT(describe(MissionSetup{}, report),
                testing::HasSubstr("do: a cruise of at most 10 min 28 s (duration_s = { cruise = 628.4 })"));
}

TEST(InfeasibilityReport, NamesAReserveAndACapacityThatSufficeAsPrinted) {
    InfeasibilityReport report;
    report.reserve_soc_percent = 12.8258;
    report.capacity_ah = 3.9431;
    MissionSetup mission;
    mission.battery.capacity_ah = 3.2;
    EXPECT_THAT(describe(mission, report),
                testing::HasSubstr("a reserve of at most 12.82 %, a battery of 3.944 Ah instead of 3.200 Ah"));
}

}  // namespace
}  // namespace flightwatt::mission
