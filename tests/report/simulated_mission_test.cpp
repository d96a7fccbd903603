// Missions as the report flies them.

#include "report/simulated_mission.h"

#include "helpers/paper_missions.h"

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(SimulateForReport, TellsMissionsOfOneNameApart) {
    const auto missions = simulate_for_report({test::paper_mission("phased"), test::paper_mission("phased")});
    EXPECT_EQ(missions[0].title, "phased");
    EXPECT_EQ(missions[1].title, "phased (2)");
}

TEST(SimulateForReport, TellsHowFarItIs) {
    std::vector<std::pair<std::size_t, std::size_t>> told;
    simulate_for_report({test::paper_mission("phased"), test::paper_mission("phased")},
                        [&](std::size_t done, std::size_t all) { told.emplace_back(done, all); });
    EXPECT_EQ(told, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 2}}));
}

TEST(SimulateForReport, EndsTheCurveWhereTheBatteryCannotDeliver) {
    auto weak = test::paper_mission("phased");
    weak.battery.resistance_ohm = 1.0;
    const auto missions = simulate_for_report({weak});
    const auto& [mission, simulation, title, planned] = missions.front();
    ASSERT_TRUE(simulation.summary.undeliverable);
    EXPECT_LE(simulation.curve.rows.back().time_s, simulation.summary.undeliverable->time_s);
    EXPECT_FALSE(planned) << "it gave its schedule";
}

TEST(SimulateForReport, HasAsManyRowsAsAScreenShows) {
    const auto missions = simulate_for_report({test::paper_mission("phased")});
    EXPECT_NEAR(static_cast<double>(missions.front().simulation.curve.rows.size()), 300.0, 30.0);
}

TEST(Describe, NamesWhatRuns) {
    const auto mission = test::paper_mission("invariant-10fps-240bit");
    EXPECT_EQ(describe(mission.compute, mission.schedule.front().run), "detection fps 10, encryption key_bits 240");
    EXPECT_EQ(describe(mission.compute, {}), "nothing");
}

}  // namespace
}  // namespace flightwatt::report
