#include "telemetry/mavlink/station_clock.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

/// Five messages a second for 100 s of an autopilot that is on for 30 s, by a clock that is right.
std::vector<BootTime> steady() {
    std::vector<BootTime> times;
    for (std::size_t i = 0; i < 500; ++i) {
        const double time_s = 0.2 * static_cast<double>(i);
        times.push_back({10 * i, time_s, 30.0 + time_s});
    }
    return times;
}

TEST(StationClock, StepsAreThoseThatTheAutopilotsClockLacks) {
    for (const double step_s : {40.0, -40.0, 8.0, -8.0, 3600.0, 1.2e8}) {
        SCOPED_TRACE(step_s);
        auto times = steady();
        for (auto& time : times)
            if (time.boot_s >= 80.0) time.received_s += step_s;
        const auto steps = find_clock_steps(times);
        ASSERT_EQ(steps.size(), 1U);
        EXPECT_NEAR(steps[0].step_s, step_s, 1e-6);
        EXPECT_EQ(steps[0].behind.place, 2500U);
        EXPECT_FALSE(steps[0].has_passed(2490, times[249].received_s));
        EXPECT_TRUE(steps[0].has_passed(2500, times[250].received_s));
        EXPECT_FALSE(steps[0].has_passed(2495, times[249].received_s + 0.05));
        EXPECT_TRUE(steps[0].has_passed(2495, times[250].received_s - 0.05));
    }
}

TEST(StationClock, HasNoStepInLostLinksLateMessagesAndRestarts) {
    EXPECT_TRUE(find_clock_steps(steady()).empty());
    EXPECT_TRUE(find_clock_steps({}).empty());
    auto lost = steady();
    std::erase_if(lost, [](const BootTime& time) { return time.boot_s > 50.0 && time.boot_s < 90.0; });
    EXPECT_TRUE(find_clock_steps(lost).empty());
    auto held_back = steady();
    for (auto& time : held_back)
        if (time.boot_s > 50.0 && time.boot_s < 90.0) time.received_s = 60.0 + 1e-3 * (time.boot_s - 50.0);
    EXPECT_TRUE(find_clock_steps(held_back).empty());
    auto late = steady();
    for (std::size_t i = 100; i < late.size(); i += 100) late[i].boot_s -= 5.0;
    EXPECT_TRUE(find_clock_steps(late).empty());
    auto restarted = steady();
    for (auto& time : restarted)
        if (time.boot_s >= 80.0) time.boot_s -= 75.0;
    EXPECT_TRUE(find_clock_steps(restarted).empty());
    auto of_two = steady();  // with one id
    for (std::size_t i = 0; i < of_two.size(); i += 2) of_two[i].boot_s += 500.0;
    EXPECT_TRUE(find_clock_steps(of_two).empty());
    auto stopped = steady();  // of an autopilot without a clock
    std::erase_if(stopped, [](const BootTime& time) { return time.boot_s > 50.0 && time.boot_s < 90.0; });
    for (auto& time : stopped) time.boot_s = 0.0;
    EXPECT_TRUE(find_clock_steps(stopped).empty());
}

TEST(StationClock, ARecordingThatIsAppendedIsNoStep) {
    auto times = steady();
    auto older = steady();
    for (auto& time : older) {
        time.received_s -= 1e6;
        time.boot_s += 400.0;
    }
    times.insert(times.end(), older.begin(), older.end());
    EXPECT_TRUE(find_clock_steps(times).empty());
}

TEST(StationClock, AnotherVehicleIsRecordedWhereKindAndBootClockChange) {
    auto times = steady();
    for (auto& time : times)
        if (time.place >= 2500) time.boot_s += 500.0;
    EXPECT_EQ(find_other_vehicles({{2400, 2520}}, times), std::vector<std::size_t>{2500});
    EXPECT_EQ(find_other_vehicles({{2400, 2495}}, times), std::vector<std::size_t>{2495}) << "its first heartbeat";
    EXPECT_EQ(find_other_vehicles({{2400, 2495}, {100, 2600}}, times), std::vector<std::size_t>{2495}) << "once";
    EXPECT_TRUE(find_other_vehicles({{1000, 1020}, {2000, 2020}}, times).empty()) << "a VTOL that states its flight";
    EXPECT_TRUE(find_other_vehicles({{2400, 6000}}, times).empty());
    EXPECT_TRUE(find_other_vehicles({{2400, 2520}}, {}).empty());
    EXPECT_TRUE(find_other_vehicles(std::vector<VehicleChange>(30, {2400, 2520}), times).empty()) << "both at once";
}

}  // namespace
}  // namespace flightwatt::telemetry
