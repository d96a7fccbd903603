#include "live/live_flight.h"

#include "base/atomic_file.h"
#include "flight/chosen_track.h"
#include "flight/load_flight.h"
#include "helpers/path_missions.h"
#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using flight::Phase;

PredictionBasis wing_basis(double remaining_s = 300.0) {
    PredictionBasis basis;
    basis.model = mechanical::read_mechanical_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    basis.landing_s = basis.model.phases[Phase::landing].duration_s;
    basis.remaining_s = remaining_s;
    basis.battery = battery::read_battery(test::source_dir() / "fits/battery/synthetic-3s.toml");
    basis.initial_soc_percent = 90.0;
    return basis;
}

/// The messages of a log until a time.
std::vector<IncomingMessage> messages_of(const std::filesystem::path& log, double until_s, double from_s = 0.0) {
    std::vector<IncomingMessage> messages;
    std::istringstream text(read_file(log));
    for (std::string line; std::getline(text, line);) {
        auto message = message_of_line(line);
        if (message && message->time_s >= from_s && message->time_s <= until_s) messages.push_back(std::move(*message));
    }
    return messages;
}

LiveOptions options_of(const std::filesystem::path& log) {
    LiveOptions options;
    options.flight = telemetry::flight_name(log);
    auto definitions = log;
    options.configuration = telemetry::read_log_configuration(definitions.replace_extension(".log"));
    return options;
}

void receive_all(LiveFlight& flight, const std::vector<IncomingMessage>& messages) {
    for (const auto& message : messages) flight.receive(message, 0.0);
}

/// What predict says of the log at a moment.
Prediction predicted(const std::filesystem::path& log, double until_s, const PredictionBasis& basis) {
    const auto series = cut_series(flight::read_flight(log), until_s);
    Remarks remarks;
    return predict_flight(basis, mechanical::progress_at(series, until_s), series, remarks);
}

void expect_same(const Prediction& live, const Prediction& expected) {
    EXPECT_EQ(live.flown.lift_off_s, expected.flown.lift_off_s);
    EXPECT_EQ(live.flown.cruise_start_s, expected.flown.cruise_start_s);
    EXPECT_EQ(live.flown.energy_wh, expected.flown.energy_wh);
    EXPECT_EQ(live.rest.energy_wh, expected.rest.energy_wh);
    EXPECT_EQ(live.interval.low_wh, expected.interval.low_wh);
    EXPECT_EQ(live.interval.high_wh, expected.interval.high_wh);
    ASSERT_EQ(live.battery.has_value(), expected.battery.has_value());
    if (!live.battery) return;
    EXPECT_EQ(live.battery->expected.soc_now_percent, expected.battery->expected.soc_now_percent);
    EXPECT_EQ(live.battery->expected.soc_percent, expected.battery->expected.soc_percent);
    EXPECT_EQ(live.battery->expected.voltage_v, expected.battery->expected.voltage_v);
    EXPECT_EQ(live.battery->worst.soc_percent, expected.battery->worst.soc_percent);
}

TEST(LiveFlight, SaysWhatPredictSaysOfTheLogAtThatMoment) {
    for (const int number : {1, 4}) {
        const auto log = test::sample(number);
        const auto basis = wing_basis();
        LiveFlight flight(options_of(log), basis, nullptr);
        const auto messages = messages_of(log, 400.0);
        for (std::size_t i = 0; i < messages.size(); ++i) {
            flight.receive(messages[i], 0.0);
            if (i % 2000 == 0) flight.look();
        }
        const auto state = flight.look();
        ASSERT_TRUE(state.prediction) << state.waits_for;
        EXPECT_EQ(state.phase, Phase::cruise);
        expect_same(*state.prediction, predicted(log, state.prediction->flown.until_s, basis));
        EXPECT_GT(state.battery->reserve_in_s.value(), 0.0);
    }
}

/// A path of legs where the flight was every 10 s.
std::shared_ptr<const mission::PathForecast> path_of(const std::filesystem::path& log, double from_s, double to_s) {
    const auto series = flight::read_flight(log);
    const auto east = chosen_track(series, "east_m");
    const auto north = chosen_track(series, "north_m");
    mission::FlightPath path;
    constexpr double leg_s = 10.0;
    for (double time_s = from_s; time_s < to_s; time_s += leg_s) {
        const double east_m = value_at(east, time_s + leg_s) - value_at(east, time_s);
        const double north_m = value_at(north, time_s + leg_s) - value_at(north, time_s);
        const double course_deg = std::atan2(east_m, north_m) * 180.0 / 3.14159265358979;
        path.elements.push_back(test::path_element(mission::Leg{std::hypot(east_m, north_m), course_deg}, 10.0));
    }
    return std::make_shared<const mission::PathForecast>(mission::PathPlan{path, {}, test::made_up_wing()});
}

TEST(LiveFlight, SaysWhatPredictSaysAlongAPath) {
    const auto log = test::sample(1);
    auto basis = wing_basis();
    basis.remaining_s.reset();
    basis.model.physical = test::made_up_wing();
    const auto cruise_s = mechanical::progress_at(flight::read_flight(log), 300.0).cruise_start_s;
    basis.path = path_of(log, cruise_s, cruise_s + 400.0);
    LiveFlight flight(options_of(log), basis, nullptr);
    receive_all(flight, messages_of(log, 300.0));
    const auto state = flight.look();
    ASSERT_TRUE(state.prediction) << state.waits_for;
    const auto expected = predicted(log, state.prediction->flown.until_s, basis);
    expect_same(*state.prediction, expected);
    EXPECT_TRUE(expected.is_sighted);
    EXPECT_EQ(state.prediction->on_path_s, expected.on_path_s);
    double planned_s = 0.0;
    for (int leg = 0; leg < static_cast<int>((300.0 - cruise_s) / 10.0); ++leg)
        planned_s += basis.path->flown().element_s[static_cast<std::size_t>(leg)];
    EXPECT_NEAR(expected.on_path_s.value(), planned_s, 12.0) << "though it is flown faster than planned";
}

TEST(LiveFlight, SaysWhatPredictSaysOfRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        const auto log = test::shared_dir() / "flights" / (std::string(name) + ".data");
        const auto basis = wing_basis();
        LiveFlight flight(options_of(log), basis, nullptr);
        receive_all(flight, messages_of(log, 900.0));
        const auto state = flight.look();
        ASSERT_TRUE(state.prediction) << name << ": " << state.waits_for;
        expect_same(*state.prediction, predicted(log, state.prediction->flown.until_s, basis));
    }
}

TEST(LiveFlight, KnowsPhasesAndSaysWhatItWaitsFor) {
    const auto log = test::sample(1);
    LiveFlight flight(options_of(log), wing_basis(), nullptr);
    const auto state_at = [&](double from_s, double until_s) {
        receive_all(flight, messages_of(log, until_s, from_s));
        return flight.look();
    };
    auto state = flight.look();
    EXPECT_TRUE(state.aircraft_id.empty());
    EXPECT_FALSE(state.waits_for.empty());
    state = state_at(0.0, 50.0);
    EXPECT_FALSE(state.phase);
    EXPECT_EQ(state.sortie, 0U);
    EXPECT_THAT(state.waits_for, testing::HasSubstr("has not taken off"));
    state = state_at(50.001, 85.0);
    EXPECT_EQ(state.phase, Phase::takeoff);
    EXPECT_THAT(state.waits_for, testing::HasSubstr("has not held its height"));
    state = state_at(85.001, 300.0);
    EXPECT_EQ(state.phase, Phase::cruise);
    EXPECT_NEAR(state.flight_s, 235.5, 2.0);
    EXPECT_TRUE(state.waits_for.empty());
    state = state_at(300.001, 1000.0);
    EXPECT_TRUE(state.landed);
    EXPECT_FALSE(state.phase);
    EXPECT_EQ(state.sortie, 1U);
    EXPECT_THAT(state.waits_for, testing::HasSubstr("has landed"));
    EXPECT_TRUE(flight.last_predicted().has_value());
}

TEST(LiveFlight, ACruiseThatTakesLongerThanPlannedHasNoEndThatIsKnown) {
    const auto log = test::sample(1);
    auto basis = wing_basis();
    basis.remaining_s.reset();
    basis.cruise_s = 150.0;
    LiveFlight flight(options_of(log), basis, nullptr);
    receive_all(flight, messages_of(log, 200.0));
    ASSERT_TRUE(flight.look().prediction);
    receive_all(flight, messages_of(log, 400.0, 200.001));
    const auto state = flight.look();
    EXPECT_FALSE(state.prediction);
    EXPECT_THAT(state.waits_for, testing::HasSubstr("longer than the mission's 150 s"));
    EXPECT_GT(state.battery->reserve_in_s.value(), 100.0);
    EXPECT_FALSE(state.battery->chance_below);
    EXPECT_GT(state.expected_power_w.value(), 10.0);
}

TEST(LiveFlight, AStartInMidFlightPredictsWithWhatIsKnown) {
    const auto log = test::sample(1);
    auto basis = wing_basis();
    basis.initial_soc_percent.reset();
    const auto state_from = [&](double from_s) {
        LiveFlight flight(options_of(log), basis, nullptr);
        receive_all(flight, messages_of(log, 500.0, from_s));
        return flight.look();
    };
    const auto whole = state_from(0.0);
    const auto state = state_from(200.0);
    EXPECT_TRUE(state.began_in_air);
    EXPECT_FALSE(state.lift_off_s);
    ASSERT_TRUE(state.prediction) << state.waits_for;
    const auto width = [](const LiveState& of) {
        return of.prediction->interval.high_wh - of.prediction->interval.low_wh;
    };
    EXPECT_TRUE(state.prediction->interval.contains(whole.prediction->rest.energy_wh));
    EXPECT_GT(width(state), 0.8 * width(whole)) << "the time that is left is told";
    EXPECT_FALSE(state.battery->soc_percent) << "its charge at the start is not known";
    EXPECT_NEAR(state.prediction->battery->expected.soc_now_percent, state.battery->soc_by_voltage_percent.value(),
                1e-9);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("that of the voltage in flight")));
    basis.initial_soc_percent = 90.0;
    const auto counted = state_from(200.0);
    EXPECT_NEAR(counted.battery->soc_percent.value(), state_from(0.0).battery->soc_percent.value(), 0.5)
        << "by the autopilot's counter";
    EXPECT_THAT(state_from(480.0).waits_for, testing::HasSubstr("seen from the air on"));
}

TEST(LiveFlight, AStartInMidFlightDoesNotKnowHowFarTheMissionIs) {
    const auto log = test::sample(1);
    auto basis = wing_basis();
    basis.remaining_s.reset();
    basis.cruise_s = 600.0;
    const auto state_from = [&](double from_s) {
        LiveFlight flight(options_of(log), basis, nullptr);
        receive_all(flight, messages_of(log, 400.0, from_s));
        return flight.look();
    };
    const auto state = state_from(200.0);
    ASSERT_TRUE(state.prediction) << state.waits_for;
    EXPECT_NEAR(state.prediction->remaining_s, 200.0, 1.0) << "half of 600 less the 200 that were seen";
    const double power_w = state.prediction->cruise.remaining_mean_w;
    const double landing_wh = state.prediction->landing.energy_wh;
    EXPECT_LE(state.prediction->interval.low_wh, landing_wh);
    EXPECT_GE(state.prediction->interval.high_wh, landing_wh + power_w * 400.0 / 3600.0);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("how far the cruise had come is not known")));
    const auto climbing = state_from(75.0);
    ASSERT_TRUE(climbing.prediction) << climbing.waits_for;
    EXPECT_TRUE(climbing.prediction->interval.contains(state_from(0.0).prediction->rest.energy_wh));
}

/// Everything that a bus brings beside the messages of the aircraft.
TEST(LiveFlight, GarbageOtherAircraftAndDamageChangeNothing) {
    const auto log = test::sample(2);
    const auto basis = wing_basis();
    std::mt19937 random(7);
    LiveFlight clean(options_of(log), basis, nullptr);
    LiveFlight disturbed(options_of(log), basis, nullptr);
    for (const auto& message : messages_of(log, 350.0)) {
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
    const auto expected = clean.look();
    const auto state = disturbed.look();
    EXPECT_EQ(state.aircraft_id, expected.aircraft_id);
    ASSERT_TRUE(state.prediction && expected.prediction) << state.waits_for;
    EXPECT_EQ(state.prediction->rest.energy_wh, expected.prediction->rest.energy_wh);
    EXPECT_EQ(state.prediction->flown.energy_wh, expected.prediction->flown.energy_wh);
    EXPECT_GT(state.others.at("99"), 0U);
    EXPECT_FALSE(state.unusable.empty());
    EXPECT_EQ(state.restarts, 0U);
}

/// Its clock is behind, goes in jumps, and begins anew: none of that is the watched aircraft's.
TEST(LiveFlight, AnotherAircraftsClockChangesNothing) {
    const auto log = test::sample(2);
    LiveFlight clean(options_of(log), wing_basis(), nullptr);
    LiveFlight disturbed(options_of(log), wing_basis(), nullptr);
    std::size_t i = 0;
    for (const auto& message : messages_of(log, 350.0)) {
        clean.receive(message, 0.0);
        disturbed.receive(message, 0.0);
        const double step_s = ++i / 50 % 2 == 0 ? 300.0 : 0.0;
        disturbed.receive({0.01 * static_cast<double>(i % 3000) + step_s, "99 ENERGY 90 9.1 30 270 1 10"}, 0.0);
    }
    const auto expected = clean.look();
    const auto state = disturbed.look();
    EXPECT_EQ(state.restarts, 0U);
    EXPECT_NEAR(state.time_s, expected.time_s, 0.1);
    ASSERT_TRUE(state.prediction && expected.prediction) << state.waits_for;
    EXPECT_EQ(state.prediction->rest.energy_wh, expected.prediction->rest.energy_wh);
    EXPECT_EQ(state.prediction->battery->expected.soc_percent, expected.prediction->battery->expected.soc_percent);
}

TEST(LiveFlight, AnAircraftIsSilentThoughOthersTalk) {
    const auto log = test::sample(1);
    LiveFlight flight(options_of(log), wing_basis(), nullptr);
    receive_all(flight, messages_of(log, 300.0));
    EXPECT_EQ(flight.look().alarms.size(), 0U);
    for (int i = 0; i <= 40; ++i) flight.receive({300.0 + i, "ground DATALINK_REPORT 7 0 0 0 0 0 0"}, 0.0);
    const auto state = flight.look();
    EXPECT_NEAR(state.time_s, 340.0, 4.5) << "less the five lines that a gap takes to be believed";
    ASSERT_EQ(state.alarms.size(), 1U);
    EXPECT_EQ(state.alarms.front().kind, "silence");
    receive_all(flight, messages_of(log, 350.0, 340.0));
    EXPECT_EQ(flight.look().alarms.size(), 0U);
}

TEST(LiveFlight, GapsAndLostMessagesDoNotEndIt) {
    const auto log = test::sample(3);
    LiveFlight flight(options_of(log), wing_basis(), nullptr);
    std::mt19937 random(11);
    for (const auto& message : messages_of(log, 400.0)) {
        const double time_s = message.time_s.value();
        const bool in_gap = time_s > 250.0 && time_s < 272.0;
        if (!in_gap && random() % 2 == 0) flight.receive(message, 0.0);
    }
    const auto state = flight.look();
    ASSERT_TRUE(state.prediction) << state.waits_for;
    const auto whole = predicted(log, 399.0, wing_basis());
    EXPECT_NEAR(state.prediction->flown.energy_wh, whole.flown.energy_wh, 0.05 * whole.flown.energy_wh);
}

TEST(LiveFlight, ALogThatBeginsAnewIsAnotherFlight) {
    const auto log = test::sample(1);
    std::vector<bool> anew;
    auto options = options_of(log);
    options.on_lines = [&](std::string_view, bool begins) {
        if (begins) anew.push_back(true);
    };
    LiveFlight flight(std::move(options), wing_basis(), nullptr);
    receive_all(flight, messages_of(log, 1000.0));
    EXPECT_TRUE(flight.look().landed);
    receive_all(flight, messages_of(log, 300.0));
    const auto state = flight.look();
    EXPECT_EQ(state.restarts, 1U);
    EXPECT_EQ(state.sortie, 2U);
    EXPECT_EQ(anew.size(), 1U);
    ASSERT_TRUE(state.prediction) << state.waits_for;
    expect_same(*state.prediction, predicted(log, state.prediction->flown.until_s, wing_basis()));
}

TEST(LiveFlight, MemoryIsBoundedAndSeveralSortiesAreCounted) {
    const auto log = test::sample(1);
    auto options = options_of(log);
    options.most_rows = 6000;  // one flight has 10,000
    LiveFlight flight(std::move(options), wing_basis(), nullptr);
    const auto messages = messages_of(log, 1000.0);
    const double day_s = messages.back().time_s.value() + 30.0;
    LiveState state;
    for (int sortie = 0; sortie < 3; ++sortie) {
        double looked_s = 0.0;
        for (auto message : messages) {
            *message.time_s += sortie * day_s;
            flight.receive(message, 0.0);
            if (*message.time_s < looked_s + 20.0) continue;
            looked_s = *message.time_s;
            state = flight.look();
            EXPECT_LE(state.rows, 6000U);
        }
        EXPECT_EQ(flight.look().sortie, static_cast<std::size_t>(sortie) + 1);
    }
    ASSERT_TRUE(flight.last_predicted());
    const auto& last = flight.last_predicted()->prediction.value();
    const double same_s = last.flown.until_s - 2.0 * day_s;
    const auto alone = predicted(log, same_s, wing_basis());
    EXPECT_NEAR(last.flown.energy_wh, alone.flown.energy_wh, 0.1);
    EXPECT_NEAR(last.battery->expected.soc_now_percent, alone.battery->expected.soc_now_percent, 2.0)
        << "its voltage at rest shows a pack of its own for each";
}

TEST(LiveFlight, WhatArrivesWithoutATimeGetsItsArrivals) {
    const auto log = test::sample(1);
    LiveFlight timed(options_of(log), wing_basis(), nullptr);
    LiveFlight untimed(options_of(log), wing_basis(), nullptr);
    for (auto message : messages_of(log, 300.0)) {
        timed.receive(message, 0.0);
        const double arrival_s = message.time_s.value();
        message.time_s.reset();
        untimed.receive(message, arrival_s);
    }
    EXPECT_EQ(timed.look().prediction->rest.energy_wh, untimed.look().prediction->rest.energy_wh);
}

TEST(LiveFlight, RaisesAlarms) {
    const auto log = test::sample(1);
    const auto kinds_of = [&](PredictionBasis basis, double silent_s, double volts_less) {
        LiveFlight flight(options_of(log), std::move(basis), nullptr);
        for (auto message : messages_of(log, 400.0)) {
            const auto at = message.text.find(" ENERGY ");
            if (volts_less > 0.0 && message.time_s > 200.0 && at != std::string::npos) {
                std::istringstream words(message.text);
                std::vector<std::string> parts;
                for (std::string word; words >> word;) parts.push_back(word);
                parts[3] = fmt::format("{}", std::stod(parts[3]) - volts_less);
                message.text = fmt::format("{}", fmt::join(parts, " "));
            }
            flight.receive(message, 0.0);
        }
        std::vector<std::string> kinds;
        for (const auto& alarm : flight.look(silent_s).alarms) kinds.push_back(alarm.kind);
        return kinds;
    };
    auto sound = wing_basis();
    sound.initial_soc_percent.reset();
    EXPECT_THAT(kinds_of(sound, 0.0, 0.0), testing::IsEmpty());
    EXPECT_THAT(kinds_of(sound, 31.0, 0.0), testing::ElementsAre("silence"));
    EXPECT_THAT(kinds_of(sound, 0.0, 0.6), testing::ElementsAre("voltage"));
    auto needy = wing_basis(2000.0);
    needy.limits.reserve_soc_percent = 60.0;
    EXPECT_THAT(kinds_of(needy, 0.0, 0.0), testing::Contains("reserve"));
    auto other = wing_basis();
    for (auto& phase : other.model.phases.values) phase.fourier.a0_w *= 2.0;
    EXPECT_THAT(kinds_of(other, 0.0, 0.0), testing::Contains("model"));
}

/// The chance is that of Student's t: half where the expected landing is just at the reserve.
TEST(LiveFlight, TheChanceOfLandingBelowTheReserveFollowsTheInterval) {
    const auto log = test::sample(1);
    const auto state_with = [&](double reserve_percent) {
        auto basis = wing_basis();
        basis.limits.reserve_soc_percent = reserve_percent;
        LiveFlight flight(options_of(log), basis, nullptr);
        receive_all(flight, messages_of(log, 400.0));
        return flight.look();
    };
    const auto state = state_with(0.0);
    const double expected = state.prediction->battery->expected.soc_percent;
    EXPECT_NEAR(state.battery->chance_below.value(), 0.0, 1e-9);
    EXPECT_NEAR(state_with(expected).battery->chance_below.value(), 0.5, 0.02);
    EXPECT_NEAR(state_with(state.prediction->battery->worst.soc_percent + 1e-6).battery->chance_below.value(), 0.025,
                0.006)
        << "of the interval's high end, where the battery's capacity has no interval";
    EXPECT_NEAR(state_with(99.0).battery->chance_below.value(), 1.0, 1e-9);
}

/// Against the sum over capacities of the chances with each.
TEST(LiveFlight, TheChanceOfLandingBelowTheReserveHoldsTheCapacitysSpread) {
    const auto messages = messages_of(test::sample(1), 400.0);
    const auto battery_with = [&](double reserve_percent, double capacity_part, double sd_part) {
        auto basis = wing_basis();
        basis.limits.reserve_soc_percent = reserve_percent;
        const double capacity_ah = basis.battery->capacity_ah;
        constexpr double half_95 = 1.96;
        basis.battery->intervals.capacity_ah =
            battery::Interval{capacity_ah * (1.0 - half_95 * sd_part), capacity_ah * (1.0 + half_95 * sd_part)};
        if (sd_part == 0.0) basis.battery->intervals.capacity_ah.reset();
        basis.battery->capacity_ah *= capacity_part;
        LiveFlight flight(options_of(test::sample(1)), basis, nullptr);
        receive_all(flight, messages);
        return flight.look();
    };
    const double expected = battery_with(0.0, 1.0, 0.0).prediction->battery->expected.soc_percent;
    for (const double sd_part : {0.01, 0.06}) {
        for (const double above_percent : {-6.0, 0.0, 2.0}) {
            const double reserve_percent = expected + above_percent;
            double weights = 0.0;
            double chance = 0.0;
            for (int i = -9; i <= 9; ++i) {
                const double z = 0.4 * i;
                const double weight = std::exp(-0.5 * z * z);
                const auto state = battery_with(reserve_percent, 1.0 + z * sd_part, 0.0);
                weights += weight;
                chance += weight * state.battery->chance_below.value();
            }
            const auto state = battery_with(reserve_percent, 1.0, sd_part);
            EXPECT_NEAR(state.battery->chance_below.value(), chance / weights, 0.02) << sd_part << " " << above_percent;
        }
    }
}

}  // namespace
}  // namespace flightwatt::live
