#include "live/live_schedule.h"

#include "base/error.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/prepared_mission.h"

#include <algorithm>

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

/// Flown as it was planned, the decisions have the utility of the simulation with nothing in its way.
TEST(LiveSchedule, DecidesAsTheAdaptivePolicyDoes) {
    const auto mission = read("paper/adaptive-replanned.toml");
    const auto simulated = simulate_prepared(mission::prepare_mission(mission), {.output_s = 1.0});
    const auto timeline = mission::timeline_of(setup_of(mission).duration_s);
    const auto& setup = setup_of(mission);
    LiveSchedule schedule(mission, true);
    battery::BatteryState state{setup.initial_soc_percent};
    double utility = 0.0;
    for (const auto phase : flight::all_phases) {
        const double duration_s = setup.duration_s[phase];
        const auto curve = time_scaled_model(setup.mechanical->phases[phase], duration_s, setup.phase_clock);
        for (double time_s = 0.0; time_s < duration_s; time_s += 1.0) {
            const auto decision = schedule.at({phase, time_s}, timeline.start_s[phase] + time_s, state);
            ASSERT_TRUE(decision) << to_string(phase) << " at " << time_s;
            const double step_s = std::min(1.0, duration_s - time_s);
            const double power_w =
                mechanical::power_w(curve, time_s + step_s / 2.0) + compute::power_w(setup.compute, decision->run);
            const double current_a = internal_current_a(setup.battery, power_w);
            state.soc_percent -= 100.0 * current_a * step_s / (3600.0 * setup.battery.capacity_ah);
            utility += decision->utility_per_s * step_s;
        }
    }
    const double expected = mean_utility(setup_of(mission), simulated.schedule, timeline.duration_s).value();
    EXPECT_NEAR(utility / timeline.duration_s, expected, 0.01 * expected);
    EXPECT_NEAR(state.soc_percent, simulated.simulation.summary.final_soc_percent.value(), 0.5);
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
