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

#include <algorithm>
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
