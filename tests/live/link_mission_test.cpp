#include "live/link_mission.h"

#include "helpers/mavlink_packets.h"
#include "telemetry/mavlink_decoder.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using test::little_endian;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

IncomingMessage message_of(const std::string& packet) { return {0.0, "1 ANY", false, {}, packet}; }

std::string count_of(test::MavlinkSender& vehicle, std::uint16_t count) {
    return vehicle.packet(44, little_endian(count) + std::string("\xF5\xBF", 2));
}

/// MISSION_ITEM_INT of a waypoint above home.
std::string item(test::MavlinkSender& vehicle, std::uint16_t seq, double latitude_deg, float altitude_m) {
    return vehicle.packet(73, little_endian(0.0F) + little_endian(0.0F) + little_endian(0.0F) + little_endian(0.0F) +
                                  little_endian(static_cast<std::int32_t>(latitude_deg * 1e7)) +
                                  little_endian(std::int32_t{80'000'000}) + little_endian(altitude_m) +
                                  little_endian(seq) + little_endian(std::uint16_t{16}) +
                                  std::string("\xF5\xBF\x03\x00\x01", 5));
}

/// "MISSION_REQUEST_INT 2" of each packet.
std::vector<std::string> asked(LinkMission& mission, double now_s) {
    std::vector<std::string> asked;
    for (const auto& packet : mission.requests(now_s)) {
        const auto read = telemetry::read_mavlink_packet(packet).value();
        const auto& name = read.name;
        EXPECT_EQ(read.of.at("target_system"), 1.0);
        asked.push_back(name + (name == "MISSION_REQUEST_INT" ? std::to_string(std::lround(read.of.at("seq"))) : ""));
    }
    return asked;
}

TEST(LinkMission, AsksForWhatIsMissingUntilItIsWhole) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    EXPECT_THAT(asked(mission, 0.0), IsEmpty()) << "no aircraft was heard";
    mission.receive(message_of(vehicle.heartbeat()));
    EXPECT_THAT(asked(mission, 0.0), ElementsAre("MISSION_REQUEST_LIST"));
    EXPECT_FALSE(mission.receive(message_of(count_of(vehicle, 3))));
    EXPECT_THAT(asked(mission, 0.5), ElementsAre("MISSION_REQUEST_INT0"));
    EXPECT_THAT(asked(mission, 1.0), IsEmpty()) << "again at most once a second";
    EXPECT_FALSE(mission.receive(message_of(item(vehicle, 0, 47.0, 0.0F))));
    EXPECT_THAT(asked(mission, 1.1), ElementsAre("MISSION_REQUEST_INT1"));
    EXPECT_FALSE(mission.receive(message_of(item(vehicle, 1, 47.01, 50.0F))));
    EXPECT_THAT(asked(mission, 1.2), ElementsAre("MISSION_REQUEST_INT2"));
    EXPECT_TRUE(mission.receive(message_of(item(vehicle, 2, 47.02, 60.0F))));
    EXPECT_THAT(asked(mission, 1.3), ElementsAre("MISSION_ACK")) << "else PX4 reports a timeout";
    EXPECT_FALSE(mission.receive(message_of(item(vehicle, 2, 47.02, 60.0F)))) << "the same once more is not new";
    EXPECT_THAT(asked(mission, 2.0), IsEmpty());
    EXPECT_EQ(mission.waypoints(),
              "QGC WPL 110\n"
              "0\t0\t3\t16\t0\t0\t0\t0\t47\t8\t0\t1\n"
              "1\t0\t3\t16\t0\t0\t0\t0\t47.01\t8\t50\t1\n"
              "2\t0\t3\t16\t0\t0\t0\t0\t47.02\t8\t60\t1\n")
        << "ArduPilot's first item is home";
}

/// PX4 gives up where an item is asked for that is not the next one: the mission was never read once a packet was lost.
TEST(LinkMission, AsksForALostItemAgainAndThenForTheWholeMission) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat(2, 12)));
    EXPECT_THAT(asked(mission, 0.0), ElementsAre("MISSION_REQUEST_LIST"));
    mission.receive(message_of(count_of(vehicle, 2)));
    EXPECT_THAT(asked(mission, 0.1), ElementsAre("MISSION_REQUEST_INT0"));
    mission.receive(message_of(item(vehicle, 0, 47.0, 50.0F)));
    for (int i = 0; i < 5; ++i) EXPECT_THAT(asked(mission, 1.0 + i), ElementsAre("MISSION_REQUEST_INT1"));
    EXPECT_THAT(asked(mission, 6.0), ElementsAre("MISSION_REQUEST_LIST"));
    mission.receive(message_of(count_of(vehicle, 2)));
    EXPECT_THAT(asked(mission, 6.1), ElementsAre("MISSION_REQUEST_INT0")) << "from the first on";
    mission.receive(message_of(vehicle.packet(47, std::string("\xF5\xBF\x01", 3))));
    EXPECT_THAT(asked(mission, 7.2), ElementsAre("MISSION_REQUEST_LIST")) << "it gave up";
}

TEST(LinkMission, DoesNotAskWhileAGroundStationReads) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat(2, 12)));
    mission.receive(message_of(vehicle.packet(44, little_endian(std::uint16_t{2}) + std::string("\xFF\xBE", 2))));
    EXPECT_THAT(asked(mission, 10.0), IsEmpty());
    mission.receive(message_of(item(vehicle, 0, 47.0, 50.0F)));
    EXPECT_THAT(asked(mission, 12.0), IsEmpty());
    EXPECT_THAT(asked(mission, 14.9), IsEmpty());
    EXPECT_THAT(asked(mission, 15.1), ElementsAre("MISSION_REQUEST_LIST")) << "the station has stopped";
}

TEST(LinkMission, StatesThatItReceivedAMissionWithoutItems) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat(2, 12)));
    EXPECT_THAT(asked(mission, 0.0), ElementsAre("MISSION_REQUEST_LIST"));
    mission.receive(message_of(count_of(vehicle, 0)));
    EXPECT_THAT(asked(mission, 0.1), ElementsAre("MISSION_ACK"));
    EXPECT_THAT(asked(mission, 9.9), IsEmpty());
    EXPECT_THAT(asked(mission, 10.1), ElementsAre("MISSION_REQUEST_LIST"));
}

// A mission of as many items is not mixed with the one before it.
TEST(LinkMission, IsNewOnceTheLastItemOfAnotherOneIsReceived) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat()));
    for (const double first_deg : {47.0, 48.0}) {
        EXPECT_FALSE(mission.receive(message_of(count_of(vehicle, 2))));
        EXPECT_FALSE(mission.receive(message_of(item(vehicle, 0, first_deg, 0.0F))));
        EXPECT_TRUE(mission.receive(message_of(item(vehicle, 1, first_deg + 0.01, 50.0F))));
    }
    EXPECT_THAT(mission.waypoints(), Not(HasSubstr("\t47")));
}

TEST(LinkMission, HasTheHomeOfOtherAutopilotsBeforeTheFirstItem) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat(2, 12)));
    mission.receive(message_of(vehicle.packet(242, little_endian(std::int32_t{470'000'000}) +
                                                       little_endian(std::int32_t{90'000'000}) +
                                                       little_endian(std::int32_t{488'000}) + std::string(40, '\0'))));
    mission.receive(message_of(count_of(vehicle, 1)));
    EXPECT_TRUE(mission.receive(message_of(item(vehicle, 0, 47.01, 50.0F))));
    EXPECT_THAT(mission.waypoints(), HasSubstr("0\t0\t0\t16\t0\t0\t0\t0\t47\t9\t488\t1\n1\t0\t3\t16\t"));
}

/// GLOBAL_POSITION_INT at 9 degrees east, 488 m above the sea; without a fix at 0.
std::string position(test::MavlinkSender& vehicle, std::int32_t latitude_1e7) {
    const std::int32_t longitude_1e7 = latitude_1e7 == 0 ? 0 : 90'000'000;
    return vehicle.packet(33, little_endian(std::uint32_t{1'000}) + little_endian(latitude_1e7) +
                                  little_endian(longitude_1e7) + little_endian(std::int32_t{488'000}) +
                                  std::string(12, '\0'));
}

/// Read before the home was set, a mission began at its first waypoint, and its return ended there.
TEST(LinkMission, BeginsWhereTheAircraftStandsUntilItsHomeIsStated) {
    constexpr std::uint8_t disarmed = 81;
    for (const std::uint8_t autopilot : {3, 12}) {
        test::MavlinkSender vehicle;
        LinkMission mission(245, 191);
        mission.receive(message_of(vehicle.heartbeat(2, autopilot)));
        mission.receive(message_of(position(vehicle, 480'000'000)));
        EXPECT_FALSE(mission.has_home()) << "it is armed: it may fly";
        mission.receive(message_of(count_of(vehicle, 2)));
        const auto nowhere =
            vehicle.packet(73, std::string(30, '\0') + "\x10" + std::string("\0\xF5\xBF\x00\x00\x01", 6));
        mission.receive(message_of(nowhere));
        EXPECT_TRUE(mission.receive(message_of(item(vehicle, 1, 47.01, 50.0F))));
        EXPECT_FALSE(mission.has_home());
        mission.receive(message_of(vehicle.heartbeat(2, autopilot, disarmed)));
        EXPECT_FALSE(mission.receive(message_of(position(vehicle, 0)))) << "no fix";
        EXPECT_TRUE(mission.receive(message_of(position(vehicle, 470'000'000))));
        EXPECT_TRUE(mission.has_home());
        EXPECT_THAT(mission.waypoints(), HasSubstr("0\t0\t0\t16\t0\t0\t0\t0\t47\t9\t488\t1\n"));
        EXPECT_FALSE(mission.receive(message_of(position(vehicle, 470'000'001)))) << "it is not read again";
    }
}

std::string home_at(test::MavlinkSender& vehicle, double latitude_deg) {
    return vehicle.packet(242, little_endian(static_cast<std::int32_t>(std::lround(latitude_deg * 1e7))) +
                                   little_endian(std::int32_t{80'000'000}) + little_endian(std::int32_t{488'000}) +
                                   std::string(40, '\0'));
}

/// A home that was set elsewhere in flight, or at arming after a walk, left the way back at the former one.
TEST(LinkMission, IsNewWhenItsHomeIsSetElsewhere) {
    constexpr double metre_deg = 1.0 / 111'320.0;
    for (const std::uint8_t autopilot : {3, 12}) {
        test::MavlinkSender vehicle;
        LinkMission mission(245, 191);
        mission.receive(message_of(vehicle.heartbeat(2, autopilot)));
        mission.receive(message_of(home_at(vehicle, 47.0)));
        mission.receive(message_of(count_of(vehicle, 2)));
        mission.receive(message_of(item(vehicle, 0, 47.0, 0.0F)));
        ASSERT_TRUE(mission.receive(message_of(item(vehicle, 1, 47.01, 50.0F))));
        EXPECT_FALSE(mission.receive(message_of(home_at(vehicle, 47.0 + 20.0 * metre_deg)))) << "it drifts";
        EXPECT_TRUE(mission.receive(message_of(home_at(vehicle, 46.98)))) << "2.2 km away";
        EXPECT_FALSE(mission.receive(message_of(home_at(vehicle, 46.98)))) << "it is known";
        EXPECT_THAT(mission.waypoints(), HasSubstr("QGC WPL 110\n0\t0\t0\t16\t0\t0\t0\t0\t46.98\t8\t488\t1\n"));
    }
}

TEST(LinkMission, OfArduPilotHasTheHomeThatWasReadLast) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat()));
    mission.receive(message_of(home_at(vehicle, 46.0)));
    mission.receive(message_of(count_of(vehicle, 1)));
    EXPECT_TRUE(mission.receive(message_of(item(vehicle, 0, 47.0, 30.0F))));
    EXPECT_THAT(mission.waypoints(), HasSubstr("\n0\t0\t3\t16\t0\t0\t0\t0\t47\t8\t30\t1\n"));
}

/// Mission Planner reads missions of MAVLink 1 by this message.
TEST(LinkMission, ReadsItemsInDegrees) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat()));
    mission.receive(message_of(count_of(vehicle, 1)));
    const auto packet = vehicle.packet(
        39, std::string(16, '\0') + little_endian(47.5F) + little_endian(8.25F) + little_endian(30.0F) +
                std::string(2, '\0') + little_endian(std::uint16_t{16}) + std::string("\xF5\xBF\x03\x00\x01", 5));
    EXPECT_TRUE(mission.receive(message_of(packet)));
    EXPECT_THAT(mission.waypoints(), HasSubstr("0\t0\t3\t16\t0\t0\t0\t0\t47.5\t8.25\t30\t1\n"));
}

/// A mission that was uploaded later stayed unread.
TEST(LinkMission, IsReadAgainAfterAnUpload) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    mission.receive(message_of(vehicle.heartbeat()));
    mission.receive(message_of(count_of(vehicle, 1)));
    ASSERT_TRUE(mission.receive(message_of(item(vehicle, 0, 47.0, 0.0F))));
    ASSERT_THAT(asked(mission, 0.9), ElementsAre("MISSION_ACK"));
    ASSERT_THAT(asked(mission, 1.0), IsEmpty());
    const auto acknowledge = [&](char type) {
        mission.receive(message_of(vehicle.packet(47, std::string("\xF5\xBF") + type)));
    };
    constexpr char accepted = 0;
    constexpr char refused = 5;
    acknowledge(refused);
    EXPECT_FALSE(mission.is_outdated()) << "it was refused";
    acknowledge(accepted);
    EXPECT_TRUE(mission.is_outdated());
    EXPECT_THAT(asked(mission, 2.0), ElementsAre("MISSION_REQUEST_LIST"));
    mission.receive(message_of(count_of(vehicle, 1)));
    EXPECT_TRUE(mission.is_outdated());
    EXPECT_TRUE(mission.receive(message_of(item(vehicle, 0, 48.0, 0.0F))));
    EXPECT_FALSE(mission.is_outdated());
}

/// The yaw of PX4's items is NaN, and a take-off has no place: the mission was new at each message, its home at 215 degrees.
TEST(LinkMission, OfPx4HasItemsWithoutYawAndPlace) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    const auto add = [&](std::uint16_t seq, std::int32_t x, std::int32_t y) {
        return mission.receive(message_of(
            vehicle.packet(73, little_endian(0.0F) + little_endian(0.0F) + little_endian(0.0F) +
                                   little_endian(std::numeric_limits<float>::quiet_NaN()) + little_endian(x) +
                                   little_endian(y) + little_endian(30.0F) + little_endian(seq) +
                                   little_endian(std::uint16_t{16}) + std::string("\xF5\xBF\x03\x00\x01", 5))));
    };
    constexpr auto nowhere = std::numeric_limits<std::int32_t>::max();
    mission.receive(message_of(vehicle.heartbeat(2, 12)));
    mission.receive(message_of(count_of(vehicle, 2)));
    add(0, nowhere, nowhere);
    EXPECT_TRUE(add(1, 470'000'000, 80'000'000));
    EXPECT_FALSE(add(1, 470'000'000, 80'000'000));
    EXPECT_EQ(mission.waypoints(),
              "QGC WPL 110\n"
              "0\t0\t0\t16\t0\t0\t0\t0\t47\t8\t0\t1\n"
              "1\t0\t3\t16\t0\t0\t0\t0\t0\t0\t30\t1\n"
              "2\t0\t3\t16\t0\t0\t0\t0\t47\t8\t30\t1\n");
    EXPECT_TRUE(mission.receive(message_of(
        vehicle.packet(242, little_endian(std::int32_t{460'000'000}) + little_endian(std::int32_t{90'000'000}) +
                                little_endian(std::int32_t{488'000}) + std::string(40, '\0')))))
        << "its home is known now";
    EXPECT_THAT(mission.waypoints(), HasSubstr("\t46\t9\t488\t"));
}

TEST(LinkMission, PassesOverFencesAndWhatIsNoPacket) {
    test::MavlinkSender vehicle;
    LinkMission mission(245, 191);
    EXPECT_FALSE(mission.receive(message_of("no packet")));
    constexpr auto fence = '\1';
    mission.receive(
        message_of(vehicle.packet(44, little_endian(std::uint16_t{1}) + std::string("\xF5\xBF", 2) + fence)));
    EXPECT_FALSE(mission.receive(message_of(item(vehicle, 0, 47.0, 50.0F))));
}

}  // namespace
}  // namespace flightwatt::live
