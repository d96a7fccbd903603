#include "live/sources/ivy_messages.h"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

class IvyMessagesTest : public testing::Test {
  protected:
    std::vector<IncomingMessage> came;
    IvyMessages messages{[this](IncomingMessage message) { came.push_back(std::move(message)); }};
};

TEST_F(IvyMessagesTest, HandOnAnAircraftsMessagesAtOnce) {
    messages.heed("20 ENERGY 57 11.62");
    messages.heed("ground FLIGHT_PARAM 20 0.1");
    messages.heed("20 PONG ");
    messages.heed("replays_of_mine START now");
    ASSERT_EQ(came.size(), 4U);
    EXPECT_EQ(came[0].text, "20 ENERGY 57 11.62");
    EXPECT_EQ(came[0].time_s, std::nullopt);
    EXPECT_EQ(came[1].text, "ground FLIGHT_PARAM 20 0.1");
    EXPECT_EQ(came[2].text, "20 PONG ");
    EXPECT_EQ(came[3].text, "replays_of_mine START now");
    messages.heed("");
    messages.heed("word");
    EXPECT_EQ(messages.no_messages(), 2U);
}

TEST_F(IvyMessagesTest, GiveAReplayTheTimeThatIsSaidAfterIt) {
    messages.heed("replay20 ENERGY 57 11.62");
    EXPECT_TRUE(came.empty());
    EXPECT_TRUE(messages.waits());
    messages.heed("time20 13.900000");
    messages.heed("replay20 ENERGY 58 11.61");
    messages.heed("time21 99");  // another aircraft's
    EXPECT_EQ(came.size(), 1U);
    messages.heed("time20 14.9");
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[0].text, "20 ENERGY 57 11.62");
    EXPECT_EQ(came[0].time_s, 13.9);
    EXPECT_EQ(came[1].time_s, 14.9);
    EXPECT_FALSE(messages.waits());
}

TEST_F(IvyMessagesTest, HandOnWhatNoTimeFollows) {
    messages.heed("replay20 ENERGY 57 11.62");
    messages.release();
    ASSERT_EQ(came.size(), 1U);
    EXPECT_EQ(came[0].time_s, std::nullopt);
    messages.heed("time20 10");
    messages.heed("replay20 ENERGY 58 11.61");
    messages.release();
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[1].time_s, 10.0);
    messages.heed("time20 noon");
    EXPECT_EQ(messages.no_messages(), 1U);
}

TEST_F(IvyMessagesTest, HeedNoReplayWhileAnAircraftIsOnTheBus) {
    messages.heed("20 ALIVE 1");
    messages.heed("replay20 ENERGY 57 11.62");
    messages.heed("time20 13.9");
    messages.heed("replay21 ENERGY 57 11.62");
    messages.heed("time21 13.9");
    messages.heed("ground WIND 20 1 2");
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[1].text, "ground WIND 20 1 2");
    EXPECT_EQ(came[1].time_s, std::nullopt);
    EXPECT_EQ(messages.unheeded_replays(), 2U);
}

TEST_F(IvyMessagesTest, TakeWhatTheGroundSaysBesideAReplayOnItsClock) {
    messages.heed("ground WIND 20 1 2");
    messages.heed("replay20 ENERGY 57 11.62");
    messages.heed("time20 13.9");
    messages.heed("ground WIND 20 1 3");
    ASSERT_EQ(came.size(), 3U);
    EXPECT_EQ(came[0].time_s, std::nullopt);
    EXPECT_EQ(came[2].time_s, 13.9);
}

}  // namespace
}  // namespace flightwatt::live
