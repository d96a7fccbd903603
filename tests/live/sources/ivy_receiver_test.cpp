#include "live/sources/ivy_receiver.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

class IvyMessagesTest : public testing::Test, public MessageSink {
  protected:
    void push(IncomingMessage message) override { came.push_back(std::move(message)); }
    void count(std::string_view reason, std::size_t times) override { unusable[std::string(reason)] += times; }

    std::vector<IncomingMessage> came;
    std::map<std::string, std::size_t> unusable;
    IvyMessages messages{*this};
};

TEST_F(IvyMessagesTest, HandOnAnAircraftsMessagesAtOnce) {
    messages.handle("20 ENERGY 57 11.62");
    messages.handle("ground FLIGHT_PARAM 20 0.1");
    messages.handle("20 PONG ");
    messages.handle("replays_of_mine START now");
    ASSERT_EQ(came.size(), 4U);
    EXPECT_EQ(came[0].text, "20 ENERGY 57 11.62");
    EXPECT_EQ(came[0].time_s, std::nullopt);
    EXPECT_EQ(came[1].text, "ground FLIGHT_PARAM 20 0.1");
    EXPECT_EQ(came[2].text, "20 PONG ");
    EXPECT_EQ(came[3].text, "replays_of_mine START now");
    messages.handle("");
    messages.handle("word");
    EXPECT_EQ(unusable.at("messages of a single word"), 2U);
}

TEST_F(IvyMessagesTest, GiveAReplayTheTimeThatIsSaidAfterIt) {
    messages.handle("replay20 ENERGY 57 11.62");
    EXPECT_TRUE(came.empty());
    messages.handle("time20 13.900000");
    messages.handle("replay20 ENERGY 58 11.61");
    messages.handle("time21 99");  // another aircraft's
    EXPECT_EQ(came.size(), 1U);
    messages.handle("time20 14.9");
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[0].text, "20 ENERGY 57 11.62");
    EXPECT_EQ(came[0].time_s, 13.9);
    EXPECT_EQ(came[1].time_s, 14.9);
}

TEST_F(IvyMessagesTest, HandOnWhatNoTimeFollows) {
    messages.handle("replay20 ENERGY 57 11.62");
    messages.release();
    ASSERT_EQ(came.size(), 1U);
    EXPECT_EQ(came[0].time_s, std::nullopt);
    messages.handle("time20 10");
    messages.handle("replay20 ENERGY 58 11.61");
    messages.release();
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[1].time_s, 10.0);
    messages.handle("time20 noon");
    EXPECT_EQ(unusable.at("messages of a single word"), 1U);
}

TEST_F(IvyMessagesTest, HeedNoReplayWhileAnAircraftIsOnTheBus) {
    messages.handle("20 ALIVE 1");
    messages.handle("replay20 ENERGY 57 11.62");
    messages.handle("time20 13.9");
    messages.handle("replay21 ENERGY 57 11.62");
    messages.handle("time21 13.9");
    messages.handle("ground WIND 20 1 2");
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[1].text, "ground WIND 20 1 2");
    EXPECT_EQ(came[1].time_s, std::nullopt);
    EXPECT_EQ(unusable.at("messages of a replay while an aircraft itself is on the bus"), 2U);
}

TEST_F(IvyMessagesTest, TakeWhatTheGroundSaysBesideAReplayOnItsClock) {
    messages.handle("ground WIND 20 1 2");
    messages.handle("replay20 ENERGY 57 11.62");
    messages.handle("time20 13.9");
    messages.handle("ground WIND 20 1 3");
    ASSERT_EQ(came.size(), 3U);
    EXPECT_EQ(came[0].time_s, std::nullopt);
    EXPECT_EQ(came[2].time_s, 13.9);
}

}  // namespace
}  // namespace flightwatt::live
