#include "mission/planning/depletion_table.h"

#include "helpers/paper_missions.h"
#include "mission/simulation.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::paper_mission;

/// State of charge after the mission's own schedule, by a table.
std::optional<double> tabled_soc(const Mission& mission) {
    const auto table = make_depletion_table(mission.setup, configurations_of(mission.schedule));
    return soc_after_schedule(table, to_indexed(mission.schedule, table));
}

/// A schedule of segments that begin and end anywhere.
std::vector<ScheduleSegment> random_schedule(const Mission& mission, std::mt19937& random) {
    const auto known = configurations_of(mission.schedule);
    std::uniform_int_distribution<std::size_t> any(0, known.size() - 1);
    std::vector<ScheduleSegment> schedule;
    for (const auto phase : flight::all_phases) {
        const double duration_s = mission.setup.duration_s[phase];
        std::uniform_real_distribution<double> length_s(0.01, 90.0);
        for (double start_s = 0.0; start_s < duration_s;) {
            const double end_s = std::min(duration_s, start_s + length_s(random));
            schedule.push_back({phase, start_s, end_s, known[any(random)]});
            start_s = end_s;
        }
    }
    return schedule;
}

TEST(DepletionTable, AgreesWithRungeKuttaOnThePapersSchedules) {
    for (const auto* name : {"computing-only", "mechanical-only", "invariant-5.8fps-32bit", "invariant-10fps-240bit",
                             "phased", "adaptive"}) {
        const auto mission = paper_mission(name);
        const auto soc = tabled_soc(mission);
        ASSERT_TRUE(soc) << name;
        EXPECT_NEAR(*soc, *simulate(mission).summary.final_soc_percent, 1e-8) << name;
    }
    EXPECT_LT(*tabled_soc(paper_mission("invariant-32fps-448bit")), 0.0) << "empty before the end";
}

TEST(DepletionTable, AgreesWithRungeKuttaOnRandomSchedules) {
    std::mt19937 random(3);
    for (const double resistance_ohm : {0.0, 0.002, 0.02, 0.04}) {
        auto mission = paper_mission("phased");
        mission.setup.battery = {"", 3.6, resistance_ohm, 6.0};
        for (int i = 0; i < 10; ++i) {
            mission.schedule = random_schedule(mission, random);
            const auto soc = tabled_soc(mission);
            const auto summary = simulate(mission, {10.0, 0.05}).summary;
            ASSERT_TRUE(soc && summary.final_soc_percent) << resistance_ohm;
            EXPECT_GT(*soc, 10.0) << "would not be empty";
            EXPECT_NEAR(*soc, *summary.final_soc_percent, 1e-6) << resistance_ohm;
        }
    }
}

TEST(DepletionTable, SaysItsError) {
    auto mission = paper_mission("phased");
    mission.setup.battery = {"", 3.6, 0.02, 6.0};
    const auto table = make_depletion_table(mission.setup, configurations_of(mission.schedule));
    EXPECT_LE(table.error_percent, 1e-8);
    EXPECT_GT(table.error_percent, 0.0);
}

TEST(DepletionTable, FollowsBothPhaseClocks) {
    for (const auto clock : {mechanical::PhaseTimeScaling::stretched, mechanical::PhaseTimeScaling::absolute}) {
        auto mission = paper_mission("mechanical-only");
        mission.setup.phase_clock = clock;
        mission.setup.duration_s[flight::Phase::cruise] = 900.5;
        mission.schedule = {{flight::Phase::takeoff, 0, 28, {}},
                            {flight::Phase::cruise, 0, 900.5, {}},
                            {flight::Phase::landing, 0, 60, {}}};
        EXPECT_NEAR(*tabled_soc(mission), *simulate(mission).summary.final_soc_percent, 1e-8);
    }
}

TEST(DepletionTable, KnowsWhereTheBatteryCannotDeliver) {
    auto mission = paper_mission("phased");
    mission.setup.battery = {"", 11.1, 0.5, 3.2};  // at most 61.6 W; the middle of the cruise needs 68
    EXPECT_TRUE(simulate(mission).summary.undeliverable);
    EXPECT_FALSE(tabled_soc(mission));
    mission.schedule = paper_mission("invariant-5.8fps-32bit").schedule;
    EXPECT_FALSE(simulate(mission).summary.undeliverable);
    EXPECT_NEAR(*tabled_soc(mission), *simulate(mission).summary.final_soc_percent, 1e-6);
}

TEST(DepletionTable, DoesNotAnswerWhereTheBatteryIsCharged) {
    auto mission = paper_mission("mechanical-only");
    mission.setup.mechanical->phases[flight::Phase::landing].fourier.a0_w -= 40.0;
    EXPECT_FALSE(tabled_soc(mission));
}

TEST(DepletionTable, RefusesAConfigurationThatItDoesNotHold) {
    const auto mission = paper_mission("phased");
    const auto table = make_depletion_table(mission.setup, {mission.schedule.front().run});
    EXPECT_THROW(to_indexed(mission.schedule, table), std::invalid_argument);
}

}  // namespace
}  // namespace flightwatt::mission
