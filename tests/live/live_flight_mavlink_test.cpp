// A flight that is received by MAVLink, with what radios do to it.

#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/telemetry_series.h"
#include "helpers/mavlink_packets.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "live/live_flight.h"
#include "live/sources/flight_packets.h"
#include "live/sources/message_readers.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

struct CollectedMessages final : MessageSink {
    void push(IncomingMessage message) override { messages.push_back(std::move(message)); }
    void count(std::string_view reason, std::size_t times) override { counts[std::string(reason)] += times; }

    std::vector<IncomingMessage> messages = {};
    std::map<std::string, std::size_t> counts = {};
};

std::shared_ptr<telemetry::MavlinkVehicles> vehicles() {
    return std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages());
}

/// The entries of a .tlog.
std::vector<std::string> entries_of(const std::string& log) {
    std::vector<std::string> entries;
    for (std::size_t at = 0; at < log.size();) {
        const std::size_t size = 8 + 12 + static_cast<unsigned char>(log[at + 9]);
        entries.push_back(log.substr(at, size));
        at += size;
    }
    return entries;
}

LiveState state_after(const std::vector<IncomingMessage>& messages) {
    LiveOptions options;
    options.is_mavlink = true;
    LiveFlight flight(options, std::nullopt, nullptr);
    for (const auto& message : messages) flight.receive(message, *message.time_s);
    flight.end();
    return flight.update();
}

double energy_wh_of_log(const std::string& log) {
    const auto flight = flight::load_flight(test::write_text(test::scratch_dir() / "whole.tlog", log));
    const auto& sortie = flight.phases.sorties.front();
    return integrated_energy_wh(flight.data.power_w, sortie.start_s(), sortie.end_s());
}

TEST(LiveFlightByMavlink, HasTheEnergyOfTheLog) {
    const auto log = test::tlog_of_flight();
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), true);
    for (std::size_t at = 0; at < log.size(); at += 1000) reader.push(std::string_view(log).substr(at, 1000));
    const auto state = state_after(received.messages);
    EXPECT_EQ(state.aircraft_id, "1");
    EXPECT_EQ(state.aircraft_name, "ArduCopter");
    EXPECT_TRUE(state.landed);
    EXPECT_NEAR(state.energy_wh.value(), energy_wh_of_log(log), 1e-9);
    EXPECT_THAT(received.counts["bytes between frames"], 0U);
}

TEST(LiveFlightByMavlink, HoldsItsEnergyWithLossLatenessAndTwoRadios) {
    const auto log = test::tlog_of_flight();
    const auto known = vehicles();
    CollectedMessages received;
    MavlinkReader first(received, known, true);
    MavlinkReader second(received, known, true);
    std::mt19937 random(7);
    std::string late;
    for (const auto& entry : entries_of(log)) {
        if (random() % 5 == 0) continue;
        if (random() % 10 == 0 && late.empty()) {
            late = entry;
            continue;
        }
        first.push(entry);
        first.push(std::exchange(late, {}));
        second.push(entry);
    }
    const auto state = state_after(received.messages);
    EXPECT_NEAR(state.energy_wh.value(), energy_wh_of_log(log), 0.02 * energy_wh_of_log(log));
    EXPECT_GT(received.counts["messages lost on the link"], 500U);
    EXPECT_EQ(state.sortie, 1U);
}

/// Each watch began with this warning, as a heartbeat came before the first power.
TEST(LiveFlightByMavlink, MissesThePowerOnlyAfterTenSeconds) {
    const auto log = test::tlog_of_flight();
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), true);
    reader.push(log);
    std::erase_if(received.messages, [](const auto& of) { return of.text.find(" SYS_STATUS") != std::string::npos; });
    const auto warnings_at = [&](double time_s) {
        LiveOptions options;
        options.is_mavlink = true;
        LiveFlight flight(options, std::nullopt, nullptr);
        for (const auto& message : received.messages)
            if (*message.time_s <= time_s) flight.receive(message, *message.time_s);
        return flight.update().warnings;
    };
    EXPECT_THAT(warnings_at(5.0), testing::IsEmpty());
    EXPECT_THAT(warnings_at(15.0), testing::Contains(testing::StartsWith("no measured power")));
}

// A log of any kind that is played as MAVLink is the same flight.
TEST(LiveFlightByMavlink, HearsAFlightThatIsPlayed) {
    const auto log = test::tlog_of_flight();
    const auto flown = flight::load_flight(test::write_text(test::scratch_dir() / "flown.tlog", log));
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), true);
    for (const auto& message : flight_packets(flown.data))
        reader.push(telemetry::tlog_entry(1.78e9 + *message.time_s, message.packet));
    const auto state = state_after(received.messages);
    EXPECT_TRUE(state.landed);
    EXPECT_NEAR(state.energy_wh.value(), energy_wh_of_log(log), 0.01 * energy_wh_of_log(log));
}

TEST(FlightPackets, HaveTheHeightAboveTheGroundAndNoCurrentAboveTheLimit) {
    flight::FlightData data;
    data.power_w.time_s = data.voltage_v.time_s = data.altitude_m.time_s = {0.0, 1.0};
    data.power_w.value = {100.0, 5'000.0};
    data.voltage_v.value = {10.0, 10.0};
    data.altitude_m.value = {400.0, 450.0};
    std::map<std::string, std::vector<double>> sent;
    for (const auto& message : flight_packets(data)) {
        const auto packet = telemetry::read_mavlink_packet(message.packet).value();
        for (const auto* field : {"current_battery", "relative_alt"})
            if (packet.name != "SYS_STATUS" && packet.of.contains(field)) sent[field].push_back(packet.of.at(field));
    }
    EXPECT_THAT(sent["current_battery"], testing::ElementsAre(1'000.0, -1.0)) << "500 A";
    EXPECT_THAT(sent["relative_alt"], testing::ElementsAre(0.0, 50'000.0));
}

/// Without it, phases of a played log began and ended up to 3 s off those of the log.
TEST(FlightPackets, StateWhetherTheAircraftHasLandedOnceThatIsKnown) {
    flight::FlightData data;
    data.power_w.time_s = data.voltage_v.time_s = {0.0, 10.0, 20.0};
    data.power_w.value = data.voltage_v.value = {10.0, 10.0, 10.0};
    const auto sent_of = [&] {
        std::vector<std::pair<double, double>> sent;
        for (const auto& message : flight_packets(data)) {
            const auto packet = telemetry::read_mavlink_packet(message.packet).value();
            if (packet.name == "EXTENDED_SYS_STATE")
                sent.emplace_back(packet.of.at("landed_state"), packet.of.at("vtol_state"));
        }
        return sent;
    };
    EXPECT_THAT(sent_of(), testing::IsEmpty());
    data.landed.time_s = {5.0, 15.0};
    data.landed.value = {0.0, 1.0};
    data.vtol_state.time_s = {0.0};
    data.vtol_state.value = {3.0};
    EXPECT_THAT(sent_of(), testing::ElementsAre(std::pair(0.0, 3.0), std::pair(2.0, 3.0), std::pair(1.0, 3.0)));
}

/// The lowest altitude was that of home: an aircraft whose barometer sinks after the landing stood 20 m above it.
TEST(FlightPackets, HaveHeightsAboveTheGroundOfTheFirstFlight) {
    auto flown = flight::load_flight(test::write_text(test::scratch_dir() / "flown.tlog", test::tlog_of_flight())).data;
    flown.altitude_m.source = "BARO.Alt";
    for (auto& altitude_m : flown.altitude_m.value) altitude_m += 400.0;
    const double end_s = flown.altitude_m.time_s.back();
    flown.altitude_m.time_s.push_back(end_s + 1.0);
    flown.altitude_m.value.push_back(380.0);
    for (const auto& message : flight_packets(flown)) {
        const auto packet = telemetry::read_mavlink_packet(message.packet).value();
        if (packet.name != "GLOBAL_POSITION_INT") continue;
        EXPECT_NEAR(packet.of.at("relative_alt"), 0.0, 500.0) << "mm";
        break;
    }
}

/// The sum of two packs, as a monitor of its own, counted next to them: the power was twice as high.
TEST(LiveFlightByMavlink, CountsMonitorsByTheParametersThatPassBy) {
    const auto power_w = [](const std::string& first_parameter) {
        test::MavlinkSender vehicle;
        std::string log = test::tlog_entry(0.0, vehicle.heartbeat());
        log += test::tlog_entry(0.0, vehicle.parameter(first_parameter, 10.0F));  // the sum of the others
        log += test::tlog_entry(0.0, vehicle.parameter("BATT2_MONITOR", 4.0F));
        log += test::tlog_entry(0.0, vehicle.parameter("BATT3_MONITOR", 4.0F));
        for (int i = 0; i < 60; ++i) {
            const auto first_ca = static_cast<std::int16_t>(900 + 17 * (i % 5));
            const auto second_ca = static_cast<std::int16_t>(1'100 - 13 * (i % 7));
            const auto sum_ca = static_cast<std::int16_t>(i % 2 == 0 ? 2'100 : 1'900);  // of another moment
            log += test::tlog_entry(i, vehicle.battery({16'000}, sum_ca, 20 * i, 0));
            log += test::tlog_entry(i, vehicle.battery({16'000}, first_ca, 9 * i, 1));
            log += test::tlog_entry(i, vehicle.battery({16'000}, second_ca, 11 * i, 2));
        }
        CollectedMessages received;
        MavlinkReader reader(received, vehicles(), true);
        reader.push(log);
        return state_after(received.messages).power_w.value();
    };
    EXPECT_GT(power_w("BATT_ANYTHING"), 500.0);
    EXPECT_NEAR(power_w("BATT_MONITOR"), 16.0 * (9.68 + 10.61), 1e-6);
}

TEST(LiveFlightByMavlink, FollowsTheVehicleThatItWasTold) {
    test::MavlinkSender other{9, 1};
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), true);
    std::string log;
    for (const auto& entry : entries_of(test::tlog_of_flight())) {
        log += entry;
        if (log.size() % 3 == 0) log += test::tlog_entry(0.0, other.heartbeat());
    }
    reader.push(log);
    const auto senders = [&](const std::string& id) {
        return std::ranges::count_if(received.messages, [&](const auto& of) { return of.text.starts_with(id + " "); });
    };
    EXPECT_GT(senders("9"), 100);
    EXPECT_GT(senders("1"), 5000);
    EXPECT_EQ(senders("255"), 0);  // a ground station
}

/// Messages of an aircraft as they are received, ten times a second.
std::vector<IncomingMessage> received_of(int count, const std::function<std::string(int tenth)>& packets) {
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), true);
    for (int i = 0; i < count; ++i) {
        const auto bytes = packets(i);
        for (std::size_t at = 0; at < bytes.size();) {
            const auto size = 12 + static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 1]));
            reader.push(test::tlog_entry(0.1 * i, bytes.substr(at, size)));
            at += size;
        }
    }
    return received.messages;
}

/// A wing in the cruise, whose height varies by 8 m.
std::string packets_of_cruise(test::MavlinkSender& wing, int tenth, bool has_height_above_home) {
    const double height_m = 80.0 + 8.0 * std::sin(tenth / 150.0);
    auto packets = wing.hud(0.0F, static_cast<float>(400.0 + height_m), 45) + wing.status(11'800, 200);
    if (has_height_above_home) packets += wing.position(0.1 * tenth, height_m);
    if (tenth % 10 == 0) packets += wing.heartbeat(1) + wing.packet(245, std::string("\0\2", 2));  // in the air
    return packets;
}

TEST(LiveFlightByMavlink, ThatIsHeardFromItsCruiseOnIsInTheAir) {
    test::MavlinkSender wing;
    const auto state = state_after(received_of(3000, [&](int i) { return packets_of_cruise(wing, i, true); }));
    EXPECT_TRUE(state.began_in_air);
    EXPECT_FALSE(state.landed);
    EXPECT_EQ(state.phase, flight::Phase::cruise);
}

TEST(LiveFlightByMavlink, HasNotLandedWhileItsAutopilotStatesThatItFlies) {
    test::MavlinkSender wing;
    LiveOptions options;
    options.is_mavlink = true;
    LiveFlight flight(options, std::nullopt, nullptr);
    for (const auto& message : received_of(4000, [&](int i) { return packets_of_cruise(wing, i, false); })) {
        flight.receive(message, *message.time_s);
        if (message.text != "1 HEARTBEAT") continue;
        ASSERT_FALSE(flight.update().landed) << *message.time_s;
    }
}

TEST(LiveFlightByMavlink, FollowsTheFirstThatFliesOfMoreThatSendMore) {
    test::MavlinkSender wing{2, 1};
    test::MavlinkSender parked{1, 1};
    const auto state = state_after(received_of(2000, [&](int i) {
        auto packets = packets_of_cruise(wing, i, true);
        for (int k = 0; k < 3; ++k) packets += parked.position(0.1 * i + 0.01 * k, 0.0) + parked.status(12'300, 20);
        return i % 10 == 0 ? parked.heartbeat(1, 3, 0) + packets : packets;
    }));
    EXPECT_EQ(state.aircraft_id, "2");
    EXPECT_TRUE(state.phase);
}

TEST(MavlinkReader, HearsTheAutopilotBehindAGenericHeartbeat) {
    test::MavlinkSender gimbal{1, 154};
    test::MavlinkSender vehicle;
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), false);
    reader.push(gimbal.heartbeat(0, 0) + vehicle.heartbeat() + vehicle.status(15'800, 0) + gimbal.heartbeat(0, 0));
    EXPECT_EQ(received.messages.size(), 3U);
    EXPECT_EQ(received.messages.back().text, "1 SYS_STATUS");
}

TEST(MavlinkReader, TwoVehiclesWithOneIdAreNoLoss) {
    test::MavlinkSender first;
    test::MavlinkSender second;
    second.sequence = 100;
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), false);
    reader.push(first.heartbeat());
    for (int i = 0; i < 1000; ++i) reader.push(first.position(i, 0.0) + second.position(i, 50.0));
    EXPECT_GT(received.counts["numbers of messages missing: two vehicles have one id, or one is heard twice"],
              10 * received.counts["messages lost on the link"]);
}

TEST(MavlinkReader, CountsBytesThatAreNoPacketsAndContinues) {
    test::MavlinkSender vehicle;
    CollectedMessages received;
    MavlinkReader reader(received, vehicles(), false);
    reader.push(vehicle.heartbeat() + "noise" + vehicle.status(15'800, 0));
    reader.push(vehicle.status(15'700, 0).substr(0, 7));
    reader.restart();
    reader.push(vehicle.status(15'600, 0));
    EXPECT_EQ(received.messages.size(), 3U);
    EXPECT_EQ(received.counts["bytes between frames"], 12U);
    EXPECT_FALSE(received.messages.front().time_s);
}

}  // namespace
}  // namespace flightwatt::live
