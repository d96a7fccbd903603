#include "telemetry/mavlink/tlog.h"

#include "helpers/mavlink_packets.h"
#include "helpers/rejected.h"

#include <bit>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<MessageRequest>& status_and_hud() {
    static const std::vector<MessageRequest> wanted{{"SYS_STATUS", {"voltage_battery"}}, {"VFR_HUD", {"alt"}}};
    return wanted;
}

std::vector<AutopilotLog> read(const std::string& bytes) { return read_tlog(bytes, "x.tlog", status_and_hud()); }

TEST(Tlog, HasTheRowsOfTheVehicleAtTheTimesOfReception) {
    test::MavlinkSender vehicle;
    test::MavlinkSender station{255, 190};
    const auto logs =
        read(test::tlog_entry(5.0, station.heartbeat(6, 8)) + test::tlog_entry(5.5, vehicle.heartbeat()) +
             test::tlog_entry(6.0, vehicle.status(15'800, 0)) + test::tlog_entry(6.1, station.status(1'000, 0)) +
             test::tlog_entry(7.5, vehicle.status(15'700, 0)));
    ASSERT_EQ(logs.size(), 1U);
    const auto& sender = logs.front().log.senders.front();
    EXPECT_EQ(sender.id, "1");
    EXPECT_THAT(sender.table("SYS_STATUS")->time_s, ElementsAre(1.0, 2.5));
    EXPECT_THAT(sender.table("SYS_STATUS")->column("voltage_battery")->values, ElementsAre(15'800.0, 15'700.0));
    EXPECT_EQ(sender.table("VFR_HUD"), nullptr);
    EXPECT_EQ(logs.front().facts.information.at("start_unix_s"), "1780000005.000000");
}

TEST(Tlog, KeepsVehiclesApart) {
    test::MavlinkSender first{1, 1};
    test::MavlinkSender second{42, 1};
    std::string log;
    for (int i = 0; i < 20; ++i)
        log += test::tlog_entry(i, first.heartbeat()) + test::tlog_entry(i, second.heartbeat(1, 12)) +
               test::tlog_entry(i, first.status(15'800, 0)) + test::tlog_entry(i, second.status(11'100, 0));
    const auto logs = read(log);
    ASSERT_EQ(logs.size(), 2U);
    for (const auto& [vehicle, voltage_mv] : {std::pair(0, 15'800.0), {1, 11'100.0}}) {
        const auto* status = logs[static_cast<std::size_t>(vehicle)].log.senders.front().table("SYS_STATUS");
        EXPECT_THAT(status->column("voltage_battery")->values, testing::Each(voltage_mv));
        EXPECT_EQ(status->time_s.size(), 20U);
    }
    EXPECT_EQ(logs.back().log.senders.front().id, "42");
}

TEST(Tlog, LeavesOtherComponentsOfTheVehicleOutExceptItsBattery) {
    test::MavlinkSender autopilot{1, 1};
    test::MavlinkSender camera{1, 100};
    test::MavlinkSender pack{1, 180};
    const auto log = test::tlog_entry(0, camera.heartbeat(30, 8)) + test::tlog_entry(0, autopilot.heartbeat()) +
                     test::tlog_entry(1, camera.status(5'000, 0)) + test::tlog_entry(1, autopilot.status(15'800, 0)) +
                     test::tlog_entry(2, pack.battery({4'000, 4'000}, 100, 5)) +
                     test::tlog_entry(3, pack.status(9'000, 0));
    const auto logs = read_tlog(log, "x.tlog", {{"SYS_STATUS", {"voltage_battery"}}, {"BATTERY_STATUS", {"id"}}});
    const auto& sender = logs.front().log.senders.front();
    EXPECT_THAT(sender.table("SYS_STATUS")->column("voltage_battery")->values, ElementsAre(15'800.0));
    EXPECT_EQ(sender.table("BATTERY_STATUS")->time_s.size(), 1U);
}

// A gimbal whose heartbeat leaves its type out comes first.
/// Half of the energy was lost without a word.
TEST(Tlog, TwoSmartBatteriesOfOneIdAreTwo) {
    test::MavlinkSender autopilot{1, 1};
    test::MavlinkSender first{1, 180};
    test::MavlinkSender second{1, 181};
    const auto log = test::tlog_entry(0, autopilot.heartbeat()) +
                     test::tlog_entry(1, first.battery({4'000, 4'000}, 100, 5)) +
                     test::tlog_entry(2, second.battery({4'000, 4'000}, 100, 5));
    const auto logs = read_tlog(log, "x.tlog", {{"BATTERY_STATUS", {"id"}}});
    const auto* table = logs.front().log.senders.front().table("BATTERY_STATUS");
    EXPECT_THAT(table->column("id")->values, ElementsAre(0.0, 1.0));
}

TEST(Tlog, ANamedAutopilotGoesBeforeAGenericHeartbeat) {
    test::MavlinkSender gimbal{1, 154};
    for (const auto& [component, autopilot] : {std::pair<std::uint8_t, std::uint8_t>{1, 0}, {7, 3}}) {
        test::MavlinkSender vehicle{1, component};
        const auto logs =
            read(test::tlog_entry(0, gimbal.heartbeat(0, 0)) + test::tlog_entry(1, vehicle.heartbeat(2, autopilot)) +
                 test::tlog_entry(2, vehicle.status(15'800, 0)) + test::tlog_entry(3, gimbal.heartbeat(0, 0)));
        ASSERT_EQ(logs.size(), 1U);
        EXPECT_NE(logs.front().log.senders.front().table("SYS_STATUS"), nullptr);
    }
}

TEST(Tlog, CountsDamageAndContinuesBehindIt) {
    test::MavlinkSender vehicle;
    std::string log = "damaged beginning";
    for (int i = 0; i < 30; ++i) {
        log += test::tlog_entry(i, vehicle.heartbeat()) + test::tlog_entry(i, vehicle.status(15'800, 0));
        if (i == 10) log += std::string(40, '\xFD');
    }
    log.resize(log.size() - 5);
    ASSERT_TRUE(is_tlog(log));
    const auto logs = read(log);
    const auto& read_log = logs.front().log;
    EXPECT_EQ(read_log.senders.front().table("SYS_STATUS")->time_s.size(), 29U);
    ASSERT_EQ(read_log.skipped.size(), 1U);
    EXPECT_EQ(read_log.skipped.front().reason, "damaged or cut off");
}

TEST(Tlog, StatesLostMessagesAndARestartOfTheAutopilot) {
    test::MavlinkSender vehicle;
    std::string log = test::tlog_entry(0, vehicle.heartbeat());
    for (int i = 0; i < 100; ++i) {
        const auto packet = vehicle.position(i < 50 ? 100 + i : i - 50, 3.0);
        if (i % 4 != 3) log += test::tlog_entry(i, packet);
    }
    const auto notes = read(log).front().facts.notes;
    EXPECT_THAT(notes, Contains(HasSubstr("the autopilot restarted at 50.0 s")));
    EXPECT_THAT(notes, Contains(HasSubstr("24.0 % of the messages of system 1 were lost on the link")));
}

/// The clock of a laptop or a computer on board is set while it records: a flight was an hour longer, or in two parts,
/// and a recording that begins years ago was refused.
/// INAV and Betaflight state microseconds there: "the autopilot restarted" at each message.
TEST(Tlog, TimesSinceTheBootInMicrosecondsShowNoRestart) {
    test::MavlinkSender vehicle;
    std::string log;
    for (int i = 0; i < 40; ++i) {
        log += test::tlog_entry(i, vehicle.heartbeat()) + test::tlog_entry(i, vehicle.position(1e3 * i, 0.0));
        log += test::tlog_entry(
            i, vehicle.packet(30, test::little_endian(static_cast<std::uint32_t>(1'000 * i)) + std::string(24, '\0')));
    }
    EXPECT_THAT(read(log).front().facts.notes, testing::IsEmpty());
}

TEST(Tlog, TimesContinueWhereTheClockOfTheStationIsSet) {
    for (const double step_s : {40.0, -40.0, 1e8}) {
        SCOPED_TRACE(step_s);
        test::MavlinkSender vehicle;
        std::string log = test::tlog_entry(0, vehicle.heartbeat());
        for (int i = 0; i < 100; ++i) {
            const double time_s = i < 50 ? i : i + step_s;
            log += test::tlog_entry(time_s, vehicle.position(100 + i, 3.0)) +
                   test::tlog_entry(time_s + 0.1, vehicle.status(15'800, 0));
        }
        const auto logs = read(log);
        const auto& time_s = logs.front().log.senders.front().table("SYS_STATUS")->time_s;
        ASSERT_EQ(time_s.size(), 100U);
        for (std::size_t i = 0; i < time_s.size(); ++i) EXPECT_NEAR(time_s[i], static_cast<double>(i) + 0.1, 1e-4);
        const auto& facts = logs.front().facts;
        EXPECT_THAT(facts.notes, Contains(HasSubstr("the clock of the computer that recorded is set")));
        EXPECT_NEAR(std::stod(facts.information.at("start_unix_s")), 1'780'000'000.0 + step_s, 1e-3)
            << "a clock that was set is right";
    }
}

/// A copter and then a wing, both with the number 1, were one aircraft with the power of both.
TEST(Tlog, VehiclesOfOneNumberThatAreFlownInTurnAreApart) {
    test::MavlinkSender copter;
    test::MavlinkSender wing;
    std::string log;
    for (int i = 0; i < 60; ++i)
        log += test::tlog_entry(i, copter.heartbeat(2)) + test::tlog_entry(i, copter.position(500 + i, 3.0)) +
               test::tlog_entry(i, copter.status(15'800, 0));
    for (int i = 200; i < 260; ++i)
        log += test::tlog_entry(i, wing.heartbeat(1)) + test::tlog_entry(i, wing.position(i - 190, 3.0)) +
               test::tlog_entry(i, wing.status(11'100, 0));
    const auto logs = read(log);
    ASSERT_EQ(logs.size(), 2U);
    for (const auto& [vehicle, voltage_mv] : {std::pair(0, 15'800.0), {1, 11'100.0}}) {
        const auto& sender = logs[static_cast<std::size_t>(vehicle)].log.senders.front();
        EXPECT_EQ(sender.id, "1");
        EXPECT_EQ(sender.table("SYS_STATUS")->time_s.size(), 60U);
        EXPECT_THAT(sender.table("SYS_STATUS")->column("voltage_battery")->values, testing::Each(voltage_mv));
    }
    EXPECT_EQ(logs.back().log.senders.front().table("SYS_STATUS")->time_s.front(), 200.0);
}

TEST(Tlog, ReadsParametersAndTextsInParts) {
    test::MavlinkSender vehicle;
    const auto part = [&](char number, const std::string& text) {
        return vehicle.packet(253, '\6' + test::padded(text, 50) + "\x07" + std::string{'\0', number});
    };
    const auto log = test::tlog_entry(0, vehicle.heartbeat()) +
                     test::tlog_entry(1, vehicle.parameter("BATT_CAPACITY", 5200.0F)) +
                     test::tlog_entry(2, part(0, std::string(50, 'a'))) + test::tlog_entry(2, part(1, "b")) +
                     test::tlog_entry(3, vehicle.status(15'800, 0));
    const auto facts = read(log).front().facts;
    EXPECT_EQ(facts.parameters.at("BATT_CAPACITY"), 5200.0);
    EXPECT_THAT(facts.texts, ElementsAre(std::string(50, 'a') + "b"));
}

TEST(Tlog, ReadsWholeParametersOfPx4ByTheirBytes) {
    test::MavlinkSender vehicle;
    const auto bits = std::bit_cast<float>(std::int32_t{4});
    const auto log = test::tlog_entry(0, vehicle.heartbeat(2, 12)) +
                     test::tlog_entry(1, vehicle.parameter("BAT1_N_CELLS", bits, 6)) +
                     test::tlog_entry(2, vehicle.status(15'800, 0));
    EXPECT_EQ(read(log).front().facts.parameters.at("BAT1_N_CELLS"), 4.0);
}

TEST(Tlog, RefusesALogWithoutAVehicle) {
    test::MavlinkSender station{255, 190};
    EXPECT_THAT(test::rejected([&] { read(test::tlog_entry(0, station.heartbeat(6, 8))); }),
                HasSubstr("x.tlog: has MAVLink, but no messages of a vehicle"));
}

/// MAVProxy's .tlog.raw was no known log.
TEST(Tlog, IsRefusedAsPacketsAlone) {
    test::MavlinkSender vehicle;
    const auto raw = vehicle.heartbeat() + vehicle.status(15'800, 0) + vehicle.heartbeat();
    EXPECT_TRUE(is_tlog(raw));
    EXPECT_THAT(test::rejected([&] { read(raw); }), HasSubstr("without times of reception"));
}

TEST(Tlog, IsNotFoundInOtherFiles) {
    EXPECT_FALSE(is_tlog(""));
    EXPECT_FALSE(is_tlog(test::dataflash_log(10)));
    EXPECT_FALSE(is_tlog(test::MavlinkSender{}.heartbeat()));  // without a time
}

/// Of a computer without a set clock it had "no telemetry in its lines".
TEST(Tlog, IsRefusedWithoutTimes) {
    test::MavlinkSender vehicle;
    const std::string unset("\0\0\0\0\5\xF5\xE1\0", 8);  // 100 s after 1970
    std::string log;
    for (int i = 0; i < 10; ++i) log += unset + vehicle.heartbeat() + unset + vehicle.position(i, 0.0);
    EXPECT_TRUE(is_tlog(log));
    EXPECT_THAT(test::rejected([&] { read_tlog(log, "a.tlog", {}); }), HasSubstr("the clock of the computer"));
    EXPECT_FALSE(is_tlog(log.substr(0, 30))) << "one packet alone";
    EXPECT_FALSE(is_tlog("12345678"));
}

}  // namespace
}  // namespace flightwatt::telemetry
