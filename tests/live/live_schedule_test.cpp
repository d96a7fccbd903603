#include "live/live_schedule.h"

#include "base/error.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using flight::Phase;

mission::MissionVariant read(const char* name) {
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    return mission::read_mission(test::source_dir() / "missions" / name, reading);
}

TEST(LiveSchedule, FollowsAScheduleThatIsGiven) {
    LiveSchedule schedule(read("paper/phased.toml"), false);
    const auto takeoff = schedule.at({Phase::takeoff, 0.0}, 0.0, std::nullopt);
    ASSERT_TRUE(takeoff);
    ASSERT_TRUE(takeoff->next);
    EXPECT_NE(*takeoff->next, takeoff->run);
    EXPECT_GT(takeoff->next_in_s, 0.0);
    EXPECT_EQ(takeoff->changes, 1U);
    const double duration_s = schedule.setup().duration_s[Phase::landing];
    const auto landing = schedule.at({Phase::landing, duration_s + 100.0}, 900.0, std::nullopt);
    ASSERT_TRUE(landing) << "a phase that takes longer stays at its end";
    EXPECT_FALSE(landing->next);
}

TEST(LiveSchedule, CannotDecideWhereNothingMayBeChosen) {
    EXPECT_THROW(LiveSchedule(read("paper/phased.toml"), true), InputError);
}

/// Flown as it was planned, the decisions are worth those of the simulation with nothing in its way. (Which of several
/// slots gets the better quality is often a tie.)
TEST(LiveSchedule, DecidesAsTheAdaptivePolicyDoes) {
    const auto mission = read("paper/adaptive-replanned.toml");
    const auto simulated = simulate_prepared(mission::prepare_mission(mission), {.output_s = 1.0});
    const auto timeline = mission::timeline_of(setup_of(mission).duration_s);
    LiveSchedule schedule(mission, true);
    double utility = 0.0;
    double last_s = 0.0;
    for (const auto& row : simulated.simulation.curve.rows) {
        const auto decision = schedule.at({row.phase, row.time_s - timeline.start_s[row.phase]}, row.time_s,
                                          battery::BatteryState{row.soc_percent});
        ASSERT_TRUE(decision) << row.time_s;
        utility += decision->utility_per_s * (row.time_s - last_s);
        last_s = row.time_s;
    }
    const double expected = mean_utility(setup_of(mission), simulated.schedule, timeline.duration_s).value();
    EXPECT_NEAR(utility / timeline.duration_s, expected, 0.03 * expected);
}

TEST(LiveSchedule, DecidesAfterWhatIsLeft) {
    const auto mission = read("paper/adaptive-replanned.toml");
    LiveSchedule full(mission, true);
    LiveSchedule nearly_empty(mission, true);
    const auto with_much = full.at({Phase::cruise, 200.0}, 0.0, battery::BatteryState{80.0});
    const auto with_little = nearly_empty.at({Phase::cruise, 200.0}, 0.0, battery::BatteryState{10.0});
    ASSERT_TRUE(with_much && with_little);
    EXPECT_GT(with_much->remaining_utility_per_s.value(), with_little->remaining_utility_per_s.value());
    EXPECT_TRUE(with_much->keeps_reserve);
    EXPECT_FALSE(with_little->keeps_reserve);
    EXPECT_FALSE(LiveSchedule(mission, true).at({Phase::cruise, 0.0}, 0.0, std::nullopt)) << "of an unknown battery";
}

}  // namespace
}  // namespace flightwatt::live
