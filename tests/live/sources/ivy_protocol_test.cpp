#include "live/sources/ivy_protocol.h"

#include "base/error.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using testing::ElementsAre;

TEST(IvyBus, IsReadAsIvysLibrariesDo) {
    const auto text_of = [](const char* bus) {
        const auto at = parse_ivy_bus(bus);
        return at.address().to_string() + ":" + std::to_string(at.port());
    };
    EXPECT_EQ(text_of("127.255.255.255:2010"), "127.255.255.255:2010");
    EXPECT_EQ(text_of("127:2011"), "127.255.255.255:2011");
    EXPECT_EQ(text_of(":2012"), "127.255.255.255:2012");
    EXPECT_EQ(text_of("10.0"), "10.0.255.255:2010");
    for (const auto* wrong :
         {"127:", "127:0", "127:65536", "127:x", "1.2.3.4.5:2010", "256:2010", "bus:2010", "192.168.1,10.31:3000"}) {
        EXPECT_THROW(parse_ivy_bus(wrong), UsageError) << wrong;
    }
}

TEST(IvyAnnouncement, IsReadAndWritten) {
    EXPECT_EQ(to_datagram({40123, "7:1:40123", "Paparazzi server"}), "3 40123 7:1:40123 Paparazzi server\n");
    const auto known = parse_announcement("3 40123 7:1:40123 Paparazzi server\n");
    ASSERT_TRUE(known);
    EXPECT_EQ(known->port, 40123);
    EXPECT_EQ(known->id, "7:1:40123");
    EXPECT_EQ(known->name, "Paparazzi server");
    // Old agents state neither id nor name.
    const auto old = parse_announcement("3 40123\n");
    ASSERT_TRUE(old);
    EXPECT_EQ(old->id + old->name, "");
    for (const auto* wrong : {"", "3\n", "4 40123 id name\n", "3 0 id\n", "3 70000 id\n", "\x99\x05\n", "x 1 id\n"}) {
        EXPECT_FALSE(parse_announcement(wrong)) << wrong;
    }
}

TEST(IvyLine, IsReadAndWritten) {
    EXPECT_EQ(to_ivy_line(IvyType::start, 4123, "watch"), "6 4123\002watch\n");
    EXPECT_EQ(to_ivy_line(IvyType::end_of_subscriptions, 0), "5 0\002\n");
    EXPECT_EQ(to_ivy_line(IvyType::message, 1, "two\nlines"), "2 1\002two lines\n");
    const auto message = parse_ivy_line("2 3\00220 ENERGY 57\003more\003");
    ASSERT_TRUE(message);
    EXPECT_EQ(message->type, 2);
    EXPECT_EQ(message->id, 3);
    EXPECT_THAT(split_groups(message->arguments), ElementsAre("20 ENERGY 57", "more"));
    EXPECT_THAT(split_groups("\003\003last"), ElementsAre("", "", "last"));
    EXPECT_THAT(split_groups(""), ElementsAre());
    EXPECT_TRUE(parse_ivy_line("0 0 \002"));  // a blank before the mark is permitted
    for (const auto* wrong : {"", "2 3", "2\002x", "a 3\002x", "2 b\002x", "\002", "2 99999999999\002"}) {
        EXPECT_FALSE(parse_ivy_line(wrong)) << wrong;
    }
}

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
    EXPECT_EQ(came.size(), 1U);
    messages.handle("time20 14.9");
    ASSERT_EQ(came.size(), 2U);
    EXPECT_EQ(came[0].text, "20 ENERGY 57 11.62");
    EXPECT_EQ(came[0].time_s, 13.9);
    EXPECT_EQ(came[1].time_s, 14.9);
}

TEST_F(IvyMessagesTest, CountTimesThatAreNotNumbers) {
    messages.handle("replay20 ENERGY 57 11.62");
    messages.handle("time20 noon");
    EXPECT_TRUE(came.empty());
    EXPECT_EQ(unusable.at("replay times that are not numbers"), 1U);
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
    EXPECT_EQ(unusable.at("messages of a replay without times, or while an aircraft itself is on the bus"), 2U);
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
