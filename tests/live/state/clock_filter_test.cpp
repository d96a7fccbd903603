#include "live/state/telemetry_store.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

std::vector<double> times_of(const std::vector<IncomingMessage>& lines) {
    std::vector<double> times;
    for (const auto& line : lines) times.push_back(line.time_s.value());
    return times;
}

std::vector<double> pushed(ClockFilter& filter, const std::vector<double>& times) {
    std::vector<IncomingMessage> accepted;
    for (const double time_s : times) filter.push({time_s, "20 PONG"}, accepted);
    return times_of(accepted);
}

TEST(ClockFilter, ShortGapsAndLateLinesCountAtOnce) {
    ClockFilter filter;
    const std::vector<double> times{10.0, 10.0, 20.0, 11.5, 29.0};
    EXPECT_EQ(pushed(filter, times), times);
    EXPECT_EQ(filter.latest_s(), 29.0);
}

TEST(ClockFilter, ADamagedTimeALittleAheadLosesNoLine) {
    ClockFilter filter;
    std::vector<double> times{10.0, 19.0};
    for (int i = 1; i <= 30; ++i) times.push_back(10.0 + 0.1 * i);
    EXPECT_EQ(pushed(filter, times), times);
    EXPECT_EQ(filter.latest_s(), 19.0);
    EXPECT_EQ(filter.steps_back(), 0U);
    EXPECT_EQ(pushed(filter, {45.0, 13.1}), (std::vector<double>{13.1}));
}

TEST(ClockFilter, ADamagedTimeIsNotBelieved) {
    ClockFilter filter;
    EXPECT_EQ(pushed(filter, {10.0, 1e9, 11.0, -5e8, 12.0}), (std::vector<double>{10.0, 11.0, 12.0}));
    EXPECT_EQ(filter.unconfirmed(), 2U);
    EXPECT_EQ(filter.latest_s(), 12.0);
}

TEST(ClockFilter, AGapIsBelievedWhenFiveLinesAgree) {
    ClockFilter filter;
    EXPECT_EQ(pushed(filter, {10.0, 500.0, 501.0, 502.0, 503.0}), (std::vector<double>{10.0}));
    EXPECT_EQ(pushed(filter, {504.0}), (std::vector<double>{500.0, 501.0, 502.0, 503.0, 504.0}));
    EXPECT_EQ(filter.latest_s(), 504.0);
    EXPECT_EQ(filter.unconfirmed(), 0U);
}

TEST(ClockFilter, AGapOfAnyDurationIsNoRestart) {
    for (const double step_s : {599.0, 601.0, 7200.0}) {
        ClockFilter filter;
        pushed(filter, {10.0});
        std::vector<IncomingMessage> accepted;
        bool restarts = false;
        for (int i = 0; i < 5; ++i) restarts = filter.push({10.0 + step_s + i, "20 PONG"}, accepted);
        EXPECT_FALSE(restarts) << step_s;
        EXPECT_EQ(accepted.size(), 5U);
        EXPECT_EQ(filter.latest_s(), 14.0 + step_s);
    }
}

TEST(ClockFilter, ItsEndBelievesWhatLiesAhead) {
    ClockFilter filter;
    pushed(filter, {10.0, 500.0, 501.0});
    std::vector<IncomingMessage> accepted;
    filter.flush(accepted);
    EXPECT_EQ(times_of(accepted), (std::vector<double>{500.0, 501.0}));
}

TEST(ClockFilter, ALogThatBeginsAnewIsARestart) {
    ClockFilter filter;
    pushed(filter, {1000.0, 1001.0});
    std::vector<IncomingMessage> accepted;
    for (int i = 0; i < 4; ++i) EXPECT_FALSE(filter.push({1.0 + i, "20 PONG"}, accepted));
    EXPECT_TRUE(filter.push({5.0, "20 PONG"}, accepted));
    EXPECT_EQ(times_of(accepted), (std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0}));
    EXPECT_EQ(filter.latest_s(), 5.0);
}

TEST(ClockFilter, LinesOutOfOrderDoNotMakeTheClockRunAway) {
    constexpr double apart_s = 5.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        ClockFilter filter;
        double time_s = 0.0;
        std::vector<double> times;
        for (int i = 0; i < 6000; ++i) {
            time_s = 100.0 + 0.1 * i;
            const double moved_s = i % 3 == 0 ? (random() % 2 == 0 ? apart_s : -apart_s) : 0.0;
            times.push_back(time_s + moved_s);
        }
        pushed(filter, times);
        EXPECT_LT(filter.latest_s(), time_s + 2.0 * apart_s) << seed;
    }
}

TEST(ClockFilter, ABlockOfEarlierLinesIsNoStep) {
    ClockFilter filter;
    std::vector<double> times;
    for (int i = 0; i < 3000; ++i) {
        times.push_back(0.1 * i);
        if (i % 300 != 299) continue;
        for (int k = 0; k < 20; ++k) times.push_back(0.1 * (i - 50 + k));  // a second time, 5 to 3 s late
    }
    pushed(filter, times);
    EXPECT_NEAR(filter.latest_s(), 299.9, 3.0);
    EXPECT_EQ(filter.steps_back(), 0U);
}

TEST(ClockFilter, AClockThatSteppedBackGoesOnFromWhereItWas) {
    ClockFilter filter;
    pushed(filter, {99.0, 99.5, 99.8, 99.9, 100.0});
    std::vector<double> times;
    for (int i = 0; i < 20; ++i) times.push_back(70.0 + i);
    const auto accepted = pushed(filter, times);
    ASSERT_EQ(accepted.size(), 20U);
    EXPECT_EQ(accepted[0], 100.0) << "once five agree";
    EXPECT_EQ(accepted[19], 119.0);
    EXPECT_EQ(filter.steps_back(), 1U);
}

}  // namespace
}  // namespace flightwatt::live
