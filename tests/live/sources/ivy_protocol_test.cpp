#include "live/sources/ivy_protocol.h"

#include "base/error.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using testing::ElementsAre;

TEST(IvyBus, IsReadAsIvysLibrariesDo) {
    const auto whole = parse_ivy_bus("127.255.255.255:2010");
    EXPECT_THAT(whole.networks, ElementsAre("127.255.255.255"));
    EXPECT_EQ(whole.port, 2010);
    EXPECT_TRUE(whole.is_local());
    EXPECT_THAT(parse_ivy_bus("127:2011").networks, ElementsAre("127.255.255.255"));
    EXPECT_EQ(parse_ivy_bus("127:2011").port, 2011);
    EXPECT_THAT(parse_ivy_bus(":2012").networks, ElementsAre("127.255.255.255"));
    EXPECT_EQ(parse_ivy_bus("10.0").port, 2010);
    const auto two = parse_ivy_bus("192.168.1,10.31:3000");
    EXPECT_THAT(two.networks, ElementsAre("192.168.1.255", "10.31.255.255"));
    EXPECT_FALSE(two.is_local());
    for (const auto* wrong :
         {"127:", "127:0", "127:65536", "127:x", "1.2.3.4.5:2010", "256:2010", "bus:2010", "127,:1x"}) {
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
    // Old agents say neither id nor name.
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
    EXPECT_THAT(groups_of(message->arguments), ElementsAre("20 ENERGY 57", "more"));
    EXPECT_THAT(groups_of("\003\003last"), ElementsAre("", "", "last"));
    EXPECT_THAT(groups_of(""), ElementsAre());
    EXPECT_TRUE(parse_ivy_line("0 0 \002"));  // a blank before the mark is let pass
    for (const auto* wrong : {"", "2 3", "2\002x", "a 3\002x", "2 b\002x", "\002", "2 99999999999\002"}) {
        EXPECT_FALSE(parse_ivy_line(wrong)) << wrong;
    }
}

}  // namespace
}  // namespace flightwatt::live
