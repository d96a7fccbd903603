#include "telemetry/mavlink/frames.h"

#include "helpers/mavlink_packets.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

TEST(MavlinkFrame, HasSenderAndFieldsInBothVersions) {
    for (const bool is_v1 : {true, false}) {
        test::MavlinkSender sender{7, 2, 250, is_v1};
        const auto frame = read_mavlink_frame(sender.status(15'800, -1) + "next");
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->system, 7);
        EXPECT_EQ(frame->component, 2);
        EXPECT_EQ(frame->sequence, 250);
        EXPECT_EQ(frame->message->layout.name, "SYS_STATUS");
        EXPECT_EQ(frame->number("voltage_battery"), 15'800.0);
        EXPECT_EQ(frame->number("current_battery"), -1.0);
        // Extensions are zeros that version 2 left out, and absent in version 1.
        EXPECT_EQ(std::isnan(frame->number("onboard_control_sensors_present_extended")), is_v1);
    }
}

TEST(MavlinkFrame, PassesASignatureOver) {
    test::MavlinkSender sender{.is_signed = true};
    const auto packet = sender.hud(13.5F, 60.0F, 40);
    const auto frame = read_mavlink_frame(packet);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->bytes, packet.size());
    EXPECT_EQ(frame->number("airspeed"), 13.5);
}

TEST(MavlinkFrame, OfUnknownMessagesHasNoFields) {
    const auto frame = read_mavlink_frame(test::MavlinkSender{}.packet(12'345, "some"));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, 12'345U);
    EXPECT_EQ(frame->message, nullptr);
}

TEST(MavlinkFrame, IsRefusedIfAnyByteIsWrong) {
    const auto packet = test::MavlinkSender{}.status(15'800, 1500);
    for (std::size_t at = 3; at < packet.size(); ++at) {
        auto damaged = packet;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        const auto frame = read_mavlink_frame(damaged);
        EXPECT_FALSE(frame && frame->message != nullptr) << at;
    }
    EXPECT_FALSE(read_mavlink_frame(packet.substr(0, packet.size() - 1)));
}

TEST(MavlinkFrame, StatesItsSizeFromTheHeaderOn) {
    const auto packet = test::MavlinkSender{}.heartbeat();
    EXPECT_EQ(mavlink_frame_bytes(packet.substr(0, 9)), std::nullopt);
    EXPECT_EQ(mavlink_frame_bytes(packet.substr(0, 10)), packet.size());
    EXPECT_EQ(mavlink_frame_bytes("telemetry"), 0U);
    EXPECT_EQ(mavlink_frame_bytes(std::string("\xFD\x01\x02\0\0\0\0\0\0\0\0", 11)), 0U);  // an unknown feature
}

TEST(MavlinkFrame, EndsItsTextAtTheFirstZero) {
    const auto frame = read_mavlink_frame(test::MavlinkSender{}.parameter("BATT_CAPACITY", 5200.0F));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->text("param_id"), "BATT_CAPACITY");
}

TEST(MavlinkSequence, CountsLostPacketsOfEachComponent) {
    MavlinkSequence sequence;
    test::MavlinkSender first{1, 1};
    test::MavlinkSender other{2, 1, 90};
    for (int i = 0; i < 1000; ++i) {
        const auto packet = first.position(i, 0.0);
        if (i % 5 != 4) {
            EXPECT_TRUE(sequence.add(*read_mavlink_frame(packet)));
        }
        EXPECT_TRUE(sequence.add(*read_mavlink_frame(other.position(i, 0.0))));
    }
    EXPECT_EQ(sequence.received(), 1800U);
    EXPECT_EQ(sequence.lost(), 199U);  // the last one is not known to be lost
}

TEST(MavlinkSequence, DoesNotCountCopiesAndLatePackets) {
    MavlinkSequence sequence;
    test::MavlinkSender sender;
    const auto a = *read_mavlink_frame(sender.position(1.0, 5.0));
    const auto b = *read_mavlink_frame(sender.position(2.0, 5.0));
    const auto c = *read_mavlink_frame(sender.position(3.0, 5.0));
    EXPECT_TRUE(sequence.add(a));
    EXPECT_TRUE(sequence.add(c));
    EXPECT_EQ(sequence.lost(), 1U);
    EXPECT_TRUE(sequence.add(b));
    EXPECT_FALSE(sequence.add(c));
    EXPECT_EQ(sequence.lost(), 0U);
    EXPECT_EQ(sequence.received(), 3U);
}

/// A radio that was 5 s later gave each value twice, and the note of two vehicles with one id.
TEST(MavlinkSequence, TakesPacketsOfARadioThatIsSecondsLaterAsCopies) {
    MavlinkSequence sequence;
    test::MavlinkSender sender;
    std::vector<MavlinkFrame> sent;
    for (std::size_t i = 0; i < 600; ++i) {
        sent.push_back(*read_mavlink_frame(sender.position(static_cast<double>(i), 5.0)));
        EXPECT_TRUE(sequence.add(sent.back()));
        if (i >= 90) {
            EXPECT_FALSE(sequence.add(sent[i - 90]));
        }
    }
    EXPECT_EQ(sequence.lost(), 0U);
}

TEST(MavlinkSequence, NoticesTwoSendersWithOneId) {
    for (const std::uint8_t apart : {40, 64, 128, 192, 216}) {
        MavlinkSequence sequence;
        test::MavlinkSender first;
        test::MavlinkSender second{1, 1, apart};
        for (int i = 0; i < 600; ++i) {
            sequence.add(*read_mavlink_frame(first.position(i, 5.0)));
            sequence.add(*read_mavlink_frame(second.position(i, 50.0)));
        }
        EXPECT_TRUE(sequence.alternates()) << apart;
    }
}

}  // namespace
}  // namespace flightwatt::telemetry
