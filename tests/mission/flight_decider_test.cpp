#include "mission/flight_decider.h"

#include "helpers/paper_missions.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

AdaptivePlanner planner() { return make_adaptive_planner(test::paper_problem("adaptive-replanned")); }

TEST(FlightDecider, LearnsThePowerThatIsFlown) {
    const auto adaptive = planner();
    FlightDecider decider(adaptive);
    EXPECT_EQ(decider.mechanical_factor(), 1.0);
    const PhaseSegment interval{Phase::cruise, 0.0, 60.0};
    const auto plan = decider.decide({Phase::cruise, 0.0}, {90.0, 0.0});
    const auto run = part_of(plan.schedule, interval);
    ASSERT_FALSE(run.empty());
    EXPECT_EQ(run.front().start_s, 0.0);
    EXPECT_EQ(run.back().end_s, 60.0);
    // As planned, nothing is learned; twice as much power moves the factor half of the way after learning_time_s.
    FlightDecider calm = decider;
    const auto& table = adaptive.planner.depletions;
    double planned_percent = 0.0;
    for (const auto& segment : tabled(run, table)) planned_percent += soc_depletion_percent(table, segment);
    calm.learn(interval, run, {90.0, 0.0}, 90.0 - planned_percent);
    EXPECT_NEAR(calm.mechanical_factor(), 1.0, 1e-9);
    const double mechanical_percent = soc_depletion_percent(adaptive.planner.mechanical_depletion, {interval, 0});
    decider.learn(interval, run, {90.0, 0.0}, 90.0 - planned_percent - 0.2 * mechanical_percent);
    const double learning_s = adaptive.known.adaptive->learning_time_s;
    EXPECT_NEAR(decider.mechanical_factor(), 1.0 + 0.2 * 60.0 / (60.0 + learning_s), 1e-9);
    const double before = decider.mechanical_factor();
    decider.learn({Phase::cruise, 60.0, 120.0}, part_of(plan.schedule, {Phase::cruise, 60.0, 120.0}), {80.0, 0.0},
                  20.0);
    EXPECT_EQ(decider.mechanical_factor(), before) << "a jump of the charge is no wind";
}

TEST(FlightDecider, RunsWhatDemandsLeastFromHereOnWhereNoPlanKeepsTheReserve) {
    const auto adaptive = planner();
    const FlightDecider decider(adaptive);
    const auto poor = decider.decide({Phase::cruise, 200.0}, {10.0, 0.0});
    EXPECT_FALSE(poor.feasible);
    ASSERT_FALSE(poor.schedule.empty());
    EXPECT_EQ(poor.schedule.front().phase, Phase::cruise);
    EXPECT_EQ(poor.schedule.front().start_s, 200.0);
}

TEST(FlightDecider, APartOfAPlanLiesWithinItsInterval) {
    const Schedule plan{
        {{Phase::takeoff, 0.0, 30.0}, {}}, {{Phase::cruise, 0.0, 50.0}, {}}, {{Phase::cruise, 50.0, 90.0}, {}}};
    const auto part = part_of(plan, {Phase::cruise, 40.0, 60.0});
    ASSERT_EQ(part.size(), 2U);
    EXPECT_EQ(part[0].start_s, 40.0);
    EXPECT_EQ(part[0].end_s, 50.0);
    EXPECT_EQ(part[1].end_s, 60.0);
    EXPECT_TRUE(part_of(plan, {Phase::landing, 0.0, 10.0}).empty());
}

}  // namespace
}  // namespace flightwatt::mission
