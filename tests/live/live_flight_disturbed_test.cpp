// What a link, other senders and clocks do to a watch.

#include "helpers/sample_logs.h"
#include "helpers/watched_logs.h"
#include "live/live_flight.h"
#include "live/live_state.h"

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

TEST(DisturbedLiveFlight, AStartInMidFlightPredictsWithWhatIsKnown) {
    const auto log = test::sample(1);
    auto basis = test::wing_basis();
    basis.initial_soc_percent.reset();
    const auto state_from = [&](double from_s) {
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, test::messages_of(log, 500.0, from_s));
        return flight.update();
    };
    const auto whole = state_from(0.0);
    const auto state = state_from(200.0);
    EXPECT_TRUE(state.began_in_air);
    EXPECT_FALSE(state.lift_off_s);
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    const auto width = [](const LiveState& of) { return of.prediction->interval.high - of.prediction->interval.low; };
    EXPECT_TRUE(state.prediction->interval.contains(whole.prediction->remaining_energy.energy_wh));
    EXPECT_GT(width(state), 0.8 * width(whole)) << "the time that is left is reported";
    EXPECT_FALSE(state.battery->soc_percent) << "its charge at the start is not known";
    EXPECT_NEAR(state.prediction->battery->expected.soc_now_percent, state.battery->soc_by_voltage_percent.value(),
                1e-9);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("the state of charge is by the voltage")));
    basis.initial_soc_percent = 90.0;
    const auto counted = state_from(200.0);
    EXPECT_NEAR(counted.battery->soc_percent.value(), state_from(0.0).battery->soc_percent.value(), 0.5)
        << "by the autopilot's counter";
    EXPECT_THAT(state_from(480.0).no_prediction_reason, testing::HasSubstr("begins in the air"));
}

TEST(DisturbedLiveFlight, AStartInMidFlightDoesNotKnowHowFarTheMissionIs) {
    const auto log = test::sample(1);
    auto basis = test::wing_basis();
    basis.remaining_s.reset();
    basis.cruise_s = 600.0;
    const auto state_from = [&](double from_s) {
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, test::messages_of(log, 400.0, from_s));
        return flight.update();
    };
    const auto state = state_from(200.0);
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    EXPECT_NEAR(state.prediction->remaining_s, 200.0, 1.0) << "half of 600 less the 200 that were seen";
    const double power_w = state.prediction->cruise.remaining_mean_w;
    const double landing_wh = state.prediction->landing.energy_wh;
    EXPECT_LE(state.prediction->interval.low, landing_wh);
    EXPECT_GE(state.prediction->interval.high, landing_wh + power_w * 400.0 / 3600.0);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("s of the mission's cruise may remain")));
    const auto climbing = state_from(75.0);
    ASSERT_TRUE(climbing.prediction) << climbing.no_prediction_reason;
    EXPECT_TRUE(climbing.prediction->interval.contains(state_from(0.0).prediction->remaining_energy.energy_wh));
}

/// Everything that a bus brings next to the messages of the aircraft.
TEST(DisturbedLiveFlight, GarbageOtherAircraftAndDamageChangeNothing) {
    const auto log = test::sample(2);
    const auto basis = test::wing_basis();
    std::mt19937 random(7);
    LiveFlight clean(test::options_of(log), basis, nullptr);
    LiveFlight disturbed(test::options_of(log), basis, nullptr);
    for (const auto& message : test::messages_of(log, 350.0)) {
        clean.receive(message, 0.0);
        disturbed.receive(message, 0.0);
        const auto time_s = message.time_s.value();
        switch (random() % 40) {
            case 0:
                disturbed.receive({time_s, "99 ENERGY 90 9.1 30 270 1 10"}, 0.0);
                break;
            case 1:
                disturbed.receive({time_s, "99 ESTIMATOR 300 0"}, 0.0);
                break;
            case 2:
                disturbed.receive({time_s + 1e7, "7 ENERGY 0 0 0 0 0 0"}, 0.0);
                break;
            case 3:
                disturbed.receive({time_s, "7 ENERGY 1 2"}, 0.0);
                break;
            case 4:
                disturbed.receive({time_s, "\x01\xff\n7 ENERGY"}, 0.0);
                break;
            case 5:
                disturbed.receive(message, 0.0);
                break;
            case 6:
                disturbed.receive({time_s, "ground FLIGHT_PARAM 7 0 0 0"}, 0.0);
                break;
            case 8:
                disturbed.receive({time_s + 45.0, "7 ENERGY 99 9.9 50 500 9 99"}, 0.0);
                break;
            case 7:
                disturbed.receive({-1e9, "7 ESTIMATOR 5000 0"}, 0.0);
                break;
            default:
                break;
        }
    }
    const auto expected = clean.update();
    const auto state = disturbed.update();
    EXPECT_EQ(state.aircraft_id, expected.aircraft_id);
    ASSERT_TRUE(state.prediction && expected.prediction) << state.no_prediction_reason;
    EXPECT_EQ(state.prediction->remaining_energy.energy_wh, expected.prediction->remaining_energy.energy_wh);
    EXPECT_EQ(state.prediction->flown.energy_wh, expected.prediction->flown.energy_wh);
    EXPECT_GT(state.other_senders.at("99"), 0U);
    EXPECT_FALSE(state.unusable.empty());
    EXPECT_EQ(state.restarts, 0U);
}

/// Its clock is behind, goes in jumps, and begins again: none of that is the watched aircraft's.
TEST(DisturbedLiveFlight, AnotherAircraftsClockChangesNothing) {
    const auto log = test::sample(2);
    LiveFlight clean(test::options_of(log), test::wing_basis(), nullptr);
    LiveFlight disturbed(test::options_of(log), test::wing_basis(), nullptr);
    std::size_t i = 0;
    for (const auto& message : test::messages_of(log, 350.0)) {
        clean.receive(message, 0.0);
        disturbed.receive(message, 0.0);
        const double step_s = ++i / 50 % 2 == 0 ? 300.0 : 0.0;
        disturbed.receive({0.01 * static_cast<double>(i % 3000) + step_s, "99 ENERGY 90 9.1 30 270 1 10"}, 0.0);
    }
    const auto expected = clean.update();
    const auto state = disturbed.update();
    EXPECT_EQ(state.restarts, 0U);
    EXPECT_NEAR(state.time_s, expected.time_s, 0.1);
    ASSERT_TRUE(state.prediction && expected.prediction) << state.no_prediction_reason;
    EXPECT_EQ(state.prediction->remaining_energy.energy_wh, expected.prediction->remaining_energy.energy_wh);
    EXPECT_EQ(state.prediction->battery->expected.soc_percent, expected.prediction->battery->expected.soc_percent);
}

TEST(DisturbedLiveFlight, AnAircraftIsSilentThoughOthersTalk) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    test::receive_all(flight, test::messages_of(log, 300.0));
    EXPECT_EQ(flight.update().alarms.size(), 0U);
    for (int i = 0; i <= 40; ++i) flight.receive({300.0 + i, "ground DATALINK_REPORT 7 0 0 0 0 0 0"}, 1.0 * i);
    const auto state = flight.update();
    EXPECT_EQ(state.time_since_message_s, 40.0);
    ASSERT_EQ(state.alarms.size(), 1U);
    EXPECT_EQ(state.alarms.front().kind, "silence");
    test::receive_all(flight, test::messages_of(log, 350.0, 340.0));
    EXPECT_EQ(flight.update().alarms.size(), 0U);
}

TEST(DisturbedLiveFlight, GapsAndLostMessagesDoNotEndIt) {
    const auto log = test::sample(3);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    std::mt19937 random(11);
    for (const auto& message : test::messages_of(log, 400.0)) {
        const double time_s = message.time_s.value();
        const bool in_gap = time_s > 250.0 && time_s < 272.0;
        if (!in_gap && random() % 2 == 0) flight.receive(message, 0.0);
    }
    const auto state = flight.update();
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    const auto whole = test::predicted(log, 399.0, test::wing_basis());
    EXPECT_NEAR(state.prediction->flown.energy_wh, whole.flown.energy_wh, 0.05 * whole.flown.energy_wh);
}

/// In flight, by an hour, as when a receiver finds the time: a gap, whose energy is the counter's.
TEST(DisturbedLiveFlight, AClockThatIsSetAheadAddsNoEnergy) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    bool is_known = false;
    for (auto message : test::messages_of(log, 400.0)) {
        if (*message.time_s > 250.0) *message.time_s += 3600.0;
        flight.receive(message, 0.0);
        if (!is_known && *flight.clock_s() > 200.0) is_known = flight.update().aircraft_id == "7";
    }
    const auto state = flight.update();
    EXPECT_EQ(state.restarts, 0U);
    EXPECT_FALSE(state.began_in_air);
    ASSERT_TRUE(state.energy_wh);
    const double flown_wh = test::predicted(log, 400.0, test::wing_basis()).flown.energy_wh;
    EXPECT_NEAR(*state.energy_wh, flown_wh, 0.01 * flown_wh);
}

TEST(DisturbedLiveFlight, ALogThatBeginsAnewIsAnotherFlight) {
    const auto log = test::sample(1);
    std::vector<bool> again;
    auto options = test::options_of(log);
    options.on_lines = [&](std::string_view, bool begins) {
        if (begins) again.push_back(true);
    };
    LiveFlight flight(std::move(options), test::wing_basis(), nullptr);
    test::receive_all(flight, test::messages_of(log, 1000.0));
    EXPECT_TRUE(flight.update().landed);
    test::receive_all(flight, test::messages_of(log, 300.0));
    const auto state = flight.update();
    EXPECT_EQ(state.restarts, 1U);
    EXPECT_EQ(state.sortie, 2U);
    EXPECT_EQ(again.size(), 1U);
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    test::expect_same(*state.prediction, test::predicted(log, state.prediction->flown.until_s, test::wing_basis()));
}

TEST(DisturbedLiveFlight, WhatArrivesWithoutATimeGetsItsArrivals) {
    const auto log = test::sample(1);
    LiveFlight timed(test::options_of(log), test::wing_basis(), nullptr);
    LiveFlight untimed(test::options_of(log), test::wing_basis(), nullptr);
    for (auto message : test::messages_of(log, 300.0)) {
        timed.receive(message, 0.0);
        const double arrival_s = message.time_s.value();
        message.time_s.reset();
        untimed.receive(message, arrival_s);
    }
    EXPECT_EQ(timed.update().prediction->remaining_energy.energy_wh,
              untimed.update().prediction->remaining_energy.energy_wh);
}

/// Of a clean stream: some lost, some doubled, some a little late, and lines of any bytes between them.
std::vector<IncomingMessage> damaged_stream(std::vector<IncomingMessage> messages, std::mt19937& random) {
    std::vector<IncomingMessage> stream;
    for (auto& message : messages) {
        const auto draw = random() % 100;
        if (draw < 10) continue;
        if (draw < 20) stream.push_back(message);
        if (draw < 25) {
            IncomingMessage garbage{message.time_s, std::string(random() % 60, ' ')};
            for (auto& c : garbage.text) c = static_cast<char>(random() % 256);
            stream.push_back(std::move(garbage));
        }
        stream.push_back(std::move(message));
        if (draw >= 90 && stream.size() > 4) std::swap(stream.back(), stream[stream.size() - 2 - random() % 3]);
    }
    return stream;
}

TEST(DisturbedLiveFlight, ADamagedStreamNeitherEndsItNorInventsAnything) {
    const auto log = test::sample(2);
    const auto clean = test::messages_of(log, 350.0);
    const auto whole = test::predicted(log, 349.0, test::wing_basis());
    for (std::uint32_t seed = 31; seed <= 36; ++seed) {
        std::mt19937 random(seed);
        LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
        test::receive_all(flight, damaged_stream(clean, random));
        const auto state = flight.update();
        ASSERT_TRUE(state.prediction) << seed << ": " << state.no_prediction_reason;
        EXPECT_EQ(state.aircraft_id, "7");
        EXPECT_EQ(state.sortie, 1U) << seed;
        EXPECT_EQ(state.restarts, 0U) << seed;
        EXPECT_NEAR(state.prediction->flown.lift_off_s, whole.flown.lift_off_s, 2.0) << seed;
        EXPECT_NEAR(state.prediction->flown.energy_wh, whole.flown.energy_wh, 0.03 * whole.flown.energy_wh) << seed;
        EXPECT_TRUE(whole.interval.contains(state.prediction->remaining_energy.energy_wh)) << seed;
    }
}

TEST(DisturbedLiveFlight, GarbageAloneIsNoFlight) {
    for (std::uint32_t seed = 41; seed <= 44; ++seed) {
        std::mt19937 random(seed);
        LiveFlight flight(test::options_of(test::sample(2)), test::wing_basis(), nullptr);
        for (int i = 0; i < 3000; ++i) {
            std::string text(random() % 80, ' ');
            for (auto& c : text) c = static_cast<char>(random() % 256);
            flight.receive({0.1 * i, std::move(text)}, 0.1 * i);
            if (i % 500 == 0) flight.update();
        }
        const auto state = flight.update();
        EXPECT_FALSE(state.prediction);
        EXPECT_FALSE(state.phase);
        EXPECT_FALSE(state.energy_wh);
        EXPECT_EQ(state.sortie, 0U);
        EXPECT_FALSE(state.no_prediction_reason.empty());
    }
}

}  // namespace
}  // namespace flightwatt::live
