#include "mission/prepared_mission.h"

#include "helpers/paper_missions.h"

#include <memory>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(PreparedMission, KeepsAScheduleThatIsGiven) {
    const auto mission = test::paper_mission("phased");
    const auto prepared = prepare_mission(mission);
    EXPECT_EQ(prepared.schedule, mission.schedule);
    EXPECT_EQ(prepared.origin, ScheduleOrigin::given);
    EXPECT_EQ(simulate_prepared(prepared).simulation.summary.final_soc_percent,
              simulate(mission).summary.final_soc_percent);
}

TEST(PreparedMission, LandsAsTheFlightsOfItsPackIndicateToo) {
    auto mission = test::paper_mission("computing-only");
    EXPECT_FALSE(simulate_prepared(prepare_mission(mission)).simulation.summary.by_flights);
    const double left_percent = *simulate(mission).summary.final_soc_percent;
    mission.battery.flight_estimate = std::make_shared<battery::FlightEstimate>(
        battery::FlightEstimate{2.0 * mission.battery.capacity_ah, {5.0, 8.0}});
    const auto summary = simulate_prepared(prepare_mission(mission)).simulation.summary;
    EXPECT_NEAR(*summary.final_soc_percent, left_percent, 1e-9);
    ASSERT_TRUE(summary.by_flights);
    EXPECT_NEAR(summary.by_flights->final_soc_percent.value(), 100.0 - (100.0 - left_percent) / 2.0, 1e-6);
}

TEST(PreparedMission, HasAPlanWhereNoneIsGiven) {
    const auto problem = test::paper_problem("plan");
    const auto flown = simulate_prepared(prepare_mission(problem));
    EXPECT_FALSE(flown.schedule.empty());
    EXPECT_EQ(flown.simulation.summary.schedule, ScheduleOrigin::optimal);
    EXPECT_TRUE(flown.simulation.summary.keeps_reserve);
    auto infeasible = problem;
    infeasible.reserve_soc_percent = 60.0;
    const auto summary = simulate_prepared(prepare_mission(infeasible)).simulation.summary;
    EXPECT_EQ(summary.schedule, ScheduleOrigin::infeasible);
    EXPECT_FALSE(summary.feasible);
}

TEST(PreparedMission, LeavesTheScheduleToAPolicy) {
    const auto prepared = prepare_mission(test::paper_problem("adaptive-replanned"));
    EXPECT_TRUE(prepared.schedule.empty());
    ASSERT_TRUE(prepared.adaptive);
    const auto flown = simulate_prepared(prepared);
    EXPECT_EQ(flown.simulation.summary.schedule, ScheduleOrigin::replanned);
    EXPECT_EQ(flown.schedule.front().start_s, 0.0);
    EXPECT_EQ(flown.schedule.back().end_s, prepared.setup.duration_s[flight::Phase::landing]);
}

}  // namespace
}  // namespace flightwatt::mission
