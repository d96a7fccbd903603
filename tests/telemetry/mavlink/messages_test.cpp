#include "telemetry/mavlink/messages.h"

#include "helpers/mavlink_packets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

// The seed follows from names, types and order of the fields: a wrong one would refuse every such packet.
TEST(MavlinkMessages, HaveTheSeedsThatMavlinkStates) {
    for (const auto& message : mavlink_messages()) {
        SCOPED_TRACE(message.layout.name);
        ASSERT_TRUE(test::mavlink_seeds().contains(message.id));
        EXPECT_EQ(message.crc_extra, test::mavlink_seeds().at(message.id));
    }
    EXPECT_EQ(mavlink_messages().size(), test::mavlink_seeds().size());
}

TEST(MavlinkMessages, HaveTheSizesThatMavlinkStates) {
    const auto sizes = [](const char* name) {
        const auto& message = mavlink_message(name);
        return std::pair(message.base_bytes, message.layout.bytes);
    };
    EXPECT_EQ(sizes("HEARTBEAT"), std::pair(std::size_t{9}, std::size_t{9}));
    EXPECT_EQ(sizes("SYS_STATUS"), std::pair(std::size_t{31}, std::size_t{43}));
    EXPECT_EQ(sizes("BATTERY_STATUS"), std::pair(std::size_t{36}, std::size_t{54}));
    EXPECT_EQ(sizes("GPS_RAW_INT"), std::pair(std::size_t{30}, std::size_t{52}));
    EXPECT_EQ(sizes("STATUSTEXT"), std::pair(std::size_t{51}, std::size_t{54}));
}

TEST(MavlinkMessages, NameTheElementsOfArrays) {
    const auto& layout = mavlink_message("BATTERY_STATUS").layout;
    ASSERT_TRUE(layout.index_of("voltages[9]"));
    EXPECT_EQ(layout.fields[*layout.index_of("voltages[9]")].offset, 28U);
    EXPECT_EQ(layout.fields[*layout.index_of("id")].offset, 32U);
    EXPECT_FALSE(layout.index_of("voltages"));
}

TEST(MavlinkMessages, AreFoundByNumber) {
    EXPECT_EQ(find_mavlink_message(74)->layout.name, "VFR_HUD");
    EXPECT_EQ(find_mavlink_message(75), nullptr);
    EXPECT_EQ(find_mavlink_message(9999), nullptr);
}

}  // namespace
}  // namespace flightwatt::telemetry
