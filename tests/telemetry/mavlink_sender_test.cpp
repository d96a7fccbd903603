#include "telemetry/mavlink_sender.h"

#include "telemetry/mavlink/frames.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

TEST(MavlinkSender, MakesPacketsThatTheReaderReads) {
    MavlinkSender sender(7, 191);
    for (int i = 0; i < 300; ++i) {
        const auto frame = read_mavlink_frame(sender.packet("NAMED_VALUE_FLOAT", {{"value", 0.5 * i}}, "fw_land"));
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->system, 7);
        EXPECT_EQ(frame->component, 191);
        EXPECT_EQ(frame->sequence, i % 256);
        EXPECT_EQ(frame->number("value"), 0.5 * i);
        EXPECT_EQ(frame->text("name"), "fw_land");
    }
}

TEST(MavlinkSender, LimitsNumbersToTheirTypes) {
    const auto frame = read_mavlink_frame(MavlinkSender().packet(
        "SYS_STATUS", {{"voltage_battery", 1e9}, {"current_battery", -1e9}, {"battery_remaining", std::nan("")}}));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->number("voltage_battery"), 65'535.0);
    EXPECT_EQ(frame->number("current_battery"), -32'768.0);
    EXPECT_EQ(frame->number("battery_remaining"), 0.0);
}

}  // namespace
}  // namespace flightwatt::telemetry
