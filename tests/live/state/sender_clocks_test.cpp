#include "live/state/sender_clocks.h"

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
        EXPECT_EQ(believed.size(), i < 4 ? 0U : i == 4 ? 5U : 1U) << "five agree, since nothing was known of it";
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

}  // namespace
}  // namespace flightwatt::live
