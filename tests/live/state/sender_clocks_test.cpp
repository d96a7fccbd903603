#include "live/state/sender_clocks.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using Anew = SenderClocks::RestartScope;

class SenderClocksTest : public testing::Test {
  protected:
    SenderClocks clocks;
    std::vector<ClockFilter::Line> believed;

    Anew push(double time_s, const std::string& sender, bool restarted = false) {
        believed.clear();
        return clocks.push({time_s, sender + " PONG"}, restarted, believed);
    }
};

TEST_F(SenderClocksTest, AnotherSendersClockDoesNotMoveThatOfTheFollowedOne) {
    for (int i = 0; i < 100; ++i) {
        push(100.0 + i, "7");
        ASSERT_EQ(believed.size(), 1U);
        const auto anew = push(3.0 + 0.5 * i, "99");
        EXPECT_EQ(anew, Anew::none);
        EXPECT_EQ(believed.size(), 1U);
        EXPECT_LE(clocks.latest_s(), 100.5 + i);
    }
    EXPECT_EQ(clocks.unconfirmed(), 0U);
    EXPECT_EQ(clocks.steps_back(), 0U);
}

TEST_F(SenderClocksTest, ARestartOfAnotherSenderIsItsOwn) {
    for (int i = 0; i < 10; ++i) {
        push(500.0 + i, "7");
        push(500.0 + i, "99");
    }
    for (int i = 0; i < 4; ++i) EXPECT_EQ(push(1.0 + i, "99"), Anew::none);
    EXPECT_EQ(push(5.0, "99"), Anew::sender);
    EXPECT_FALSE(clocks.is_followed("99"));
    EXPECT_EQ(push(510.0, "7"), Anew::none);
    EXPECT_EQ(clocks.latest_s(), 510.0);
}

TEST_F(SenderClocksTest, ASourceThatBeganAnewNeedsNoOthersToAgree) {
    push(30.0, "7");
    push(30.0, "ground");
    EXPECT_EQ(push(1.0, "ground", true), Anew::all);
    EXPECT_EQ(believed.size(), 1U);
    EXPECT_EQ(push(1.0, "7"), Anew::none);
    EXPECT_EQ(believed.size(), 1U);
    EXPECT_EQ(push(40.0, "7", true), Anew::none) << "a clock that went on";
    EXPECT_EQ(push(-9.0, "new", true), Anew::all) << "late by the clock of the followed sender";
}

TEST_F(SenderClocksTest, TheClockGoesOnWithTheOthersWhileTheFollowedOneIsSilent) {
    push(100.0, "7");
    for (int i = 0; i < 40; ++i) push(98.0 + i, "ground");
    EXPECT_NEAR(clocks.latest_s(), 137.0, 2.1);
    EXPECT_NEAR(clocks.silent_s(), 37.0, 2.1);
    clocks.follow("nobody");
    push(107.5, "7");
    EXPECT_EQ(clocks.latest_s(), 107.5);
    EXPECT_EQ(clocks.silent_s(), 0.0);
}

TEST_F(SenderClocksTest, ManySendersShareAClock) {
    push(10.0, "7");
    for (int i = 0; i < 10'000; ++i) push(10.0, std::to_string(1000 + i));
    push(11.0, "7");
    EXPECT_EQ(clocks.latest_s(), 11.0);
}

std::vector<double> times_of(const std::vector<ClockFilter::Line>& lines) {
    std::vector<double> times;
    for (const auto& line : lines) times.push_back(line.time_s);
    return times;
}

std::vector<double> pushed(ClockFilter& filter, const std::vector<double>& times) {
    std::vector<ClockFilter::Line> believed;
    for (const double time_s : times) filter.push({time_s, "20 PONG"}, believed);
    return times_of(believed);
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

/// Lines of ten a second, each with its arrival.
struct Link {
    ClockFilter filter;
    std::vector<ClockFilter::Line> believed;
    double arrival_s = 1000.0;
    void go_on(double clock_s, double for_s, double pace = 1.0) {
        for (double t = 0.0; t < for_s; t += 0.1) filter.push({clock_s + t, "20 PONG", arrival_s + pace * t}, believed);
        arrival_s += pace * for_s;
    }
};

TEST(ClockFilter, AClockThatIsSetAheadIsToldFromAGapByTheArrivals) {
    Link link;
    link.go_on(10.0, 70.0);
    link.arrival_s += 4.0;
    link.go_on(3680.0, 20.0);
    EXPECT_NEAR(link.filter.latest_s(), 10.0 + 70.0 + 4.0 + 20.0, 0.3);
    EXPECT_NEAR(link.filter.set_ahead_s(), 3596.0, 0.3);
    link.arrival_s += 22.0;
    link.go_on(3722.0, 10.0);
    EXPECT_NEAR(link.filter.latest_s(), 10.0 + 70.0 + 4.0 + 20.0 + 22.0 + 10.0, 0.3) << "a gap stays one";
    EXPECT_NEAR(link.filter.set_ahead_s(), 3596.0, 0.3);
}

TEST(ClockFilter, ArrivalsOfALogThatIsReadAtOnceSayNothing) {
    Link link;
    link.go_on(10.0, 70.0, 0.01);
    link.go_on(500.0, 20.0, 0.01);
    EXPECT_NEAR(link.filter.latest_s(), 520.0, 0.3);
    EXPECT_EQ(link.filter.set_ahead_s(), 0.0);
    Link bursts;
    for (double clock_s = 10.0; clock_s < 90.0; clock_s += 8.0) {
        bursts.go_on(clock_s, 8.0, 0.0);
        bursts.arrival_s += 8.0;
    }
    bursts.go_on(130.0, 8.0, 0.0);
    EXPECT_NEAR(bursts.filter.latest_s(), 138.0, 0.3) << "of a file that is written in bursts";
}

TEST(ClockFilter, ItsEndBelievesWhatLiesAhead) {
    ClockFilter filter;
    pushed(filter, {10.0, 500.0, 501.0});
    std::vector<ClockFilter::Line> believed;
    filter.flush(believed);
    EXPECT_EQ(times_of(believed), (std::vector<double>{500.0, 501.0}));
}

TEST(ClockFilter, ALogThatBeginsAnewIsARestart) {
    ClockFilter filter;
    pushed(filter, {1000.0, 1001.0});
    std::vector<ClockFilter::Line> believed;
    for (int i = 0; i < 4; ++i) EXPECT_FALSE(filter.push({1.0 + i, "20 PONG"}, believed));
    EXPECT_TRUE(filter.push({5.0, "20 PONG"}, believed));
    EXPECT_EQ(times_of(believed), (std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0}));
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
    const auto believed = pushed(filter, times);
    ASSERT_EQ(believed.size(), 20U);
    EXPECT_EQ(believed[0], 100.0) << "once five agree";
    EXPECT_EQ(believed[19], 119.0);
    EXPECT_EQ(filter.steps_back(), 1U);
}

}  // namespace
}  // namespace flightwatt::live
