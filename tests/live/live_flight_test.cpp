#include "live/live_flight.h"

#include "helpers/flight_progress.h"
#include "helpers/path_missions.h"
#include "helpers/sample_logs.h"
#include "helpers/selected_tracks.h"
#include "helpers/watched_logs.h"
#include "live/live_state.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using flight::Phase;

TEST(LiveFlight, SaysWhatPredictSaysOfTheLogAtThatMoment) {
    for (const int number : {1, 4}) {
        const auto log = test::sample(number);
        const auto basis = test::wing_basis();
        LiveFlight flight(test::options_of(log), basis, nullptr);
        const auto messages = test::messages_of(log, 400.0);
        for (std::size_t i = 0; i < messages.size(); ++i) {
            flight.receive(messages[i], 0.0);
            if (i % 2000 == 0) flight.update();
        }
        const auto state = flight.update();
        ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
        EXPECT_EQ(state.phase, Phase::cruise);
        test::expect_same(*state.prediction, test::predicted(log, state.prediction->flown.until_s, basis));
        EXPECT_GT(state.battery->time_to_reserve_s.value(), 0.0);
    }
}

TEST(LiveFlight, PowerThatEndsInFlightIsAnAlarmAndNoPrediction) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    auto messages = test::messages_of(log, 400.0);
    std::erase_if(messages,
                  [](const auto& of) { return of.time_s > 300.0 && of.text.find(" ESTIMATOR ") == std::string::npos; });
    const auto state_at = [&](double time_s) {
        std::erase_if(messages, [&](const auto& of) {
            const bool is_due = of.time_s <= time_s;
            if (is_due) flight.receive(of, *of.time_s);
            return is_due;
        });
        return flight.update();
    };
    const auto before = state_at(325.0);
    EXPECT_TRUE(before.prediction) << before.no_prediction_reason;
    EXPECT_TRUE(before.alarms.empty());
    const auto after = state_at(345.0);
    EXPECT_FALSE(after.prediction);
    EXPECT_THAT(after.no_prediction_reason, testing::StartsWith("telemetry of power: none for 4"));
    EXPECT_FALSE(after.energy_wh || after.power_w || after.battery);
    ASSERT_EQ(after.alarms.size(), 1U);
    EXPECT_EQ(after.alarms.front().kind, "silence");
}

TEST(LiveFlight, TheTimeLeftRunsDownWhileTheLinkIsSilent) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    test::receive_all(flight, test::messages_of(log, 400.0));
    const auto now = flight.update();
    const auto later = flight.update(20.0);
    EXPECT_NEAR(later.turn_home->latest_in_s.value(), now.turn_home->latest_in_s.value() - 20.0, 1e-9);
    EXPECT_NEAR(later.battery->time_to_reserve_s.value(), now.battery->time_to_reserve_s.value() - 20.0, 1e-9);
    EXPECT_EQ(flight.update(1e6).turn_home->latest_in_s, 0.0);
}

TEST(LiveFlight, WarnsOfAMissionThatIsUncertain) {
    auto basis = test::wing_basis();
    basis.uncertain = {"the plan is not flown as it is: item 3: the jump to item 1 is not flown: it has no end"};
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), basis, nullptr);
    test::receive_all(flight, test::messages_of(log, 100.0));
    EXPECT_THAT(flight.update().warnings, testing::Contains("what is ahead may take more: " + basis.uncertain.front()));
}

TEST(LiveFlight, WarnsOfACapacityThatContradictsTheFlights) {
    const auto log = test::sample(1);
    auto basis = test::wing_basis();
    basis.battery_file = "pack.toml";
    const auto warnings_with = [&](double high_ah) {
        basis.battery->flight_estimate =
            std::make_shared<battery::FlightEstimate>(battery::FlightEstimate{2.0, {1.8, high_ah}});
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, test::messages_of(log, 100.0));
        return flight.update().warnings;
    };
    EXPECT_THAT(
        warnings_with(2.4),
        testing::Contains(testing::StartsWith("pack.toml: battery: the capacity of 3.2 Ah contradicts the flights")));
    EXPECT_THAT(warnings_with(3.2), testing::Not(testing::Contains(testing::HasSubstr("contradicts the flights"))));
}

/// A path of legs where the flight was every 10 s.
std::shared_ptr<const path::PathForecast> path_of(const std::filesystem::path& log, double from_s, double to_s) {
    const auto series = flight::read_flight(log);
    const auto east = select_track(series, "east_m");
    const auto north = select_track(series, "north_m");
    path::FlightPath path;
    constexpr double leg_s = 10.0;
    for (double time_s = from_s; time_s < to_s; time_s += leg_s) {
        const double east_m = value_at(east, time_s + leg_s) - value_at(east, time_s);
        const double north_m = value_at(north, time_s + leg_s) - value_at(north, time_s);
        const double course_deg = std::atan2(east_m, north_m) * 180.0 / 3.14159265358979;
        path.elements.push_back(test::path_element(path::Leg{std::hypot(east_m, north_m), course_deg}, 10.0));
    }
    return std::make_shared<const path::PathForecast>(path::PlannedPath{path, {}, test::made_up_wing()});
}

/// When the cruise of the log begins [s].
double cruise_start_s(const std::filesystem::path& log) {
    return test::progress_at(flight::read_flight(log), 300.0).cruise_start_s;
}

/// The wing along the log's own path, for this long from the beginning of its cruise.
PredictionInput basis_along(const std::filesystem::path& log, double path_s) {
    auto basis = test::wing_basis();
    basis.remaining_s.reset();
    basis.model.physical = test::made_up_wing();
    basis.path = path_of(log, cruise_start_s(log), cruise_start_s(log) + path_s);
    return basis;
}

TEST(LiveFlight, SaysWhatPredictSaysAlongAPath) {
    const auto log = test::sample(1);
    const auto cruise_s = cruise_start_s(log);
    const auto basis = basis_along(log, 400.0);
    LiveFlight flight(test::options_of(log), basis, nullptr);
    test::receive_all(flight, test::messages_of(log, 300.0));
    const auto state = flight.update();
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    const auto expected = test::predicted(log, state.prediction->flown.until_s, basis);
    test::expect_same(*state.prediction, expected);
    EXPECT_TRUE(expected.is_from_position);
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
        const auto basis = test::wing_basis();
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, test::messages_of(log, 900.0));
        const auto state = flight.update();
        ASSERT_TRUE(state.prediction) << name << ": " << state.no_prediction_reason;
        test::expect_same(*state.prediction, test::predicted(log, state.prediction->flown.until_s, basis));
    }
}

/// Nothing is received for 20 minutes of a flight, of which the log has 150 s.
std::vector<IncomingMessage> messages_with_lost_link(const std::filesystem::path& log, double until_s) {
    auto messages = test::messages_of(log, 200.0);
    for (auto& message : test::messages_of(log, until_s, 350.0)) {
        *message.time_s += 1200.0 - 150.0;
        messages.push_back(std::move(message));
    }
    return messages;
}

TEST(LiveFlight, GoesOnAfterALostLink) {
    const auto log = test::sample(1);
    const auto state_after = [&](const std::vector<IncomingMessage>& messages) {
        LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
        test::receive_all(flight, messages);
        return flight.update();
    };
    const auto whole = state_after(test::messages_of(log, 450.0));
    const auto state = state_after(messages_with_lost_link(log, 450.0));
    EXPECT_EQ(state.restarts, 0U);
    EXPECT_EQ(state.phase, Phase::cruise);
    EXPECT_NEAR(state.lift_off_s.value(), whole.lift_off_s.value(), 0.01);
    EXPECT_NEAR(state.flight_time_s, whole.flight_time_s + 1050.0, 0.01);
    EXPECT_NEAR(state.energy_wh.value(), whole.energy_wh.value(), 0.05) << "by the counter";
    EXPECT_NEAR(state.battery->soc_percent.value(), whole.battery->soc_percent.value(), 0.2);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("gap of 1201 s from 199.4 s on")));
    EXPECT_TRUE(state.prediction) << state.no_prediction_reason;
}

TEST(LiveFlight, DoesNotKnowTheEnergyOfALostLinkWithoutACounter) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    for (auto message : messages_with_lost_link(log, 450.0)) {
        std::istringstream words(message.text);
        std::vector<std::string> fields{std::istream_iterator<std::string>(words), {}};
        if (fields.at(1) == "ENERGY") {  // throttle, voltage, current, power, charge, energy
            fields.at(6) = fields.at(7) = "0";
            message.text = fmt::format("{}", fmt::join(fields, " "));
        }
        flight.receive(message, 0.0);
    }
    const auto state = flight.update();
    EXPECT_EQ(state.phase, Phase::cruise);
    EXPECT_FALSE(state.energy_wh);
    EXPECT_FALSE(state.prediction);
    EXPECT_THAT(state.no_prediction_reason, testing::HasSubstr("no counter shows its energy"));
}

TEST(LiveFlight, KnowsPhasesAndSaysWhatItWaitsFor) {
    const auto log = test::sample(1);
    LiveFlight flight(test::options_of(log), test::wing_basis(), nullptr);
    const auto state_at = [&](double from_s, double until_s) {
        test::receive_all(flight, test::messages_of(log, until_s, from_s));
        return flight.update();
    };
    auto state = flight.update();
    EXPECT_TRUE(state.aircraft_id.empty());
    EXPECT_FALSE(state.no_prediction_reason.empty());
    state = state_at(0.0, 50.0);
    EXPECT_FALSE(state.phase);
    EXPECT_EQ(state.sortie, 0U);
    EXPECT_THAT(state.no_prediction_reason, testing::HasSubstr("has not taken off"));
    state = state_at(50.001, 85.0);
    EXPECT_EQ(state.phase, Phase::takeoff);
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    test::expect_same(*state.prediction, test::predicted(log, state.prediction->flown.until_s, test::wing_basis()));
    const double early_wh = state.prediction->interval.high - state.prediction->interval.low;
    state = state_at(85.001, 300.0);
    EXPECT_EQ(state.phase, Phase::cruise);
    EXPECT_NEAR(state.flight_time_s, 235.5, 2.0);
    EXPECT_TRUE(state.no_prediction_reason.empty());
    EXPECT_LT(state.prediction->interval.high - state.prediction->interval.low, early_wh);
    state = state_at(300.001, 1000.0);
    EXPECT_TRUE(state.landed);
    EXPECT_FALSE(state.phase);
    EXPECT_EQ(state.sortie, 1U);
    EXPECT_THAT(state.no_prediction_reason, testing::HasSubstr("has landed"));
    EXPECT_TRUE(flight.last_predicted().has_value());
}

/// A flight at 100 m that comes down at 300 s, stays for some seconds and climbs again; down for good at 600 s.
std::vector<IncomingMessage> touch_and_go(double ground_s, double bounce_m) {
    std::vector<IncomingMessage> messages;
    for (int tick = 0; tick < 6600; ++tick) {
        const double time_s = 0.1 * tick;
        const double touched_s = time_s - 300.0;
        double height_m = std::clamp(std::min(2.5 * (time_s - 40.0), 2.5 * (600.0 - time_s)), 0.0, 100.0);
        if (touched_s > -40.0 && touched_s < ground_s + 40.0)
            height_m = std::min(100.0, 2.5 * std::max({-touched_s, touched_s - ground_s, 0.0}));
        if (touched_s > 0.0 && touched_s < ground_s) height_m = bounce_m * std::abs(std::sin(3.0 * touched_s));
        const bool flies = time_s > 40.0 && time_s < 600.0;
        const bool idles = !flies || (touched_s > -20.0 && touched_s < ground_s);
        const double power_w = idles ? 1.0 : 30.0;
        if (tick % 5 == 0)
            messages.push_back(
                {time_s, fmt::format("7 ENERGY {} 11.5 {:.3f} {:.1f} 0 0", idles ? 0 : 60, power_w / 11.5, power_w)});
        if (tick % 5 == 2) messages.push_back({time_s, fmt::format("7 ESTIMATOR {:.2f} 0", 180.0 + height_m)});
    }
    return messages;
}

TEST(LiveFlight, ATouchAndGoIsNoLanding) {
    for (const auto& [ground_s, bounce_m] : {std::pair{0.2, 0.0}, {1.0, 0.0}, {3.0, 0.8}, {6.0, 0.0}, {6.0, 1.5}}) {
        LiveFlight flight({}, std::nullopt, nullptr);
        double looked_s = 0.0;
        double landed_s = 0.0;
        double energy_wh = 0.0;
        for (const auto& message : touch_and_go(ground_s, bounce_m)) {
            flight.receive(message, 0.0);
            if (*message.time_s < looked_s + 0.5) continue;
            looked_s = *message.time_s;
            const auto state = flight.update();
            EXPECT_GE(state.energy_wh.value_or(0.0), energy_wh - 0.05) << looked_s << " s, " << ground_s;
            energy_wh = state.energy_wh.value_or(0.0);
            EXPECT_LE(state.sortie, 1U);
            if (state.landed && landed_s == 0.0) landed_s = looked_s;
        }
        EXPECT_NEAR(landed_s, 611.0, 4.0) << ground_s << " s on the ground, bounces " << bounce_m;
        EXPECT_NEAR(energy_wh, 30.0 * 520.0 / 3600.0, 0.4);
    }
}

TEST(LiveFlight, ALogThatEndsOrFallsSilentOnTheGroundHasLanded) {
    LiveFlight flight({}, std::nullopt, nullptr);
    for (const auto& message : touch_and_go(1.0, 0.0))
        if (*message.time_s < 605.0) flight.receive(message, 0.0);
    EXPECT_FALSE(flight.update().landed);
    EXPECT_FALSE(flight.update(20.0).landed);
    EXPECT_TRUE(flight.update(31.0).landed) << "switched off";
    flight.end();
    EXPECT_TRUE(flight.update().landed);
}

TEST(LiveFlight, ACruiseThatTakesLongerThanPlannedIsPredictedAsALandingFromNow) {
    const auto log = test::sample(1);
    auto basis = test::wing_basis();
    basis.remaining_s.reset();
    basis.cruise_s = 150.0;
    LiveFlight flight(test::options_of(log), basis, nullptr);
    test::receive_all(flight, test::messages_of(log, 200.0));
    ASSERT_TRUE(flight.update().prediction);
    test::receive_all(flight, test::messages_of(log, 400.0, 200.001));
    const auto state = flight.update();
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    EXPECT_NEAR(state.prediction->overtime_s.value(), state.prediction->flown.cruise_s() - 150.0, 1e-9);
    EXPECT_EQ(state.prediction->remaining_s, 0.0);
    EXPECT_EQ(state.prediction->remaining_energy.energy_wh, state.prediction->landing.energy_wh);
    EXPECT_NEAR(state.expected_power_w.value(),
                3600.0 * state.prediction->flown.cruise_energy_wh / state.prediction->flown.cruise_s(), 1e-9);
    EXPECT_THAT(state.warnings, testing::Contains(testing::HasSubstr("at the mean power of this cruise")));
    // It can land until shortly before the reserve is reached at that power.
    const double reserve_s = state.battery->time_to_reserve_s.value();
    EXPECT_GT(reserve_s, 1000.0);
    EXPECT_LT(state.turn_home->latest_in_s.value(), reserve_s);
    EXPECT_GT(state.turn_home->latest_in_s.value(), 0.9 * reserve_s);
    EXPECT_FALSE(state.turn_home->path_can_be_flown);
    EXPECT_LT(state.battery->probability_below_reserve.value(), 0.01);
}

TEST(LiveFlight, AStartInTheAirAfterThePlannedCruiseIsALandingFromNow) {
    const auto log = test::sample(1);
    auto basis = test::wing_basis();
    basis.remaining_s.reset();
    basis.cruise_s = 100.0;
    LiveFlight flight(test::options_of(log), basis, nullptr);
    test::receive_all(flight, test::messages_of(log, 420.0, 200.0));
    const auto state = flight.update();
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    EXPECT_TRUE(state.prediction->began_in_air);
    EXPECT_GT(state.prediction->overtime_s.value(), 50.0);
}

TEST(LiveFlight, ACompletedPathIsPredictedAsALandingFromNow) {
    const auto log = test::sample(1);
    const auto basis = basis_along(log, 100.0);
    LiveFlight flight(test::options_of(log), basis, nullptr);
    test::receive_all(flight, test::messages_of(log, 420.0));
    const auto state = flight.update();
    ASSERT_TRUE(state.prediction) << state.no_prediction_reason;
    EXPECT_GT(state.prediction->overtime_s.value(), 100.0);
    EXPECT_EQ(state.prediction->on_path_s, basis.path->flown().duration_s);
    EXPECT_GT(state.turn_home->latest_in_s.value(), 100.0);
}

TEST(LiveFlight, MemoryIsBoundedAndSeveralSortiesAreCounted) {
    const auto log = test::sample(1);
    auto options = test::options_of(log);
    options.max_rows = 6000;  // one flight has 10,000
    LiveFlight flight(std::move(options), test::wing_basis(), nullptr);
    const auto messages = test::messages_of(log, 1000.0);
    const double day_s = messages.back().time_s.value() + 30.0;
    LiveState state;
    for (int sortie = 0; sortie < 3; ++sortie) {
        double looked_s = 0.0;
        for (auto message : messages) {
            *message.time_s += sortie * day_s;
            flight.receive(message, 0.0);
            if (*message.time_s < looked_s + 20.0) continue;
            looked_s = *message.time_s;
            state = flight.update();
            EXPECT_LE(state.rows, 6000U);
        }
        EXPECT_EQ(flight.update().sortie, static_cast<std::size_t>(sortie) + 1);
    }
    ASSERT_TRUE(flight.last_predicted());
    const auto& last = flight.last_predicted()->prediction.value();
    const double same_s = last.flown.until_s - 2.0 * day_s;
    const auto alone = test::predicted(log, same_s, test::wing_basis());
    EXPECT_NEAR(last.flown.energy_wh, alone.flown.energy_wh, 0.1);
    EXPECT_NEAR(last.battery->expected.soc_now_percent, alone.battery->expected.soc_now_percent, 2.0)
        << "its voltage at rest shows a pack of its own for each";
}

/// The first 400 s of a log, after half of them with less voltage.
std::vector<IncomingMessage> messages_with_less_voltage(const std::filesystem::path& log, double volts_less) {
    auto messages = test::messages_of(log, 400.0);
    for (auto& message : messages) {
        if (message.time_s <= 200.0 || message.text.find(" ENERGY ") == std::string::npos) continue;
        std::istringstream words(message.text);
        std::vector<std::string> parts;
        for (std::string word; words >> word;) parts.push_back(word);
        parts[3] = fmt::format("{}", std::stod(parts[3]) - volts_less);
        message.text = fmt::format("{}", fmt::join(parts, " "));
    }
    return messages;
}

/// With the alarm "the voltage is too low for this charge" the page stated the landing by the counter: "80.8 %, keeps
/// the reserve".
TEST(LiveFlight, AVoltageThatContradictsTheChargeReachesLandingProbabilityAndTimes) {
    const auto log = test::sample(1);
    const auto state_with = [&](double volts_less) {
        auto basis = test::wing_basis();
        basis.initial_soc_percent.reset();
        basis.limits.reserve_soc_percent = 55.0;
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, messages_with_less_voltage(log, volts_less));
        return flight.update();
    };
    const auto sound = state_with(0.0);
    const auto failing = state_with(0.6);
    ASSERT_TRUE(sound.prediction && failing.prediction);
    const auto& landing = failing.prediction->battery->expected;
    EXPECT_NEAR(failing.battery->soc_percent.value(), sound.battery->soc_percent.value(), 1.0) << "as counted";
    EXPECT_NEAR(landing.soc_now_percent, failing.battery->soc_by_voltage_percent.value(), 1e-9);
    EXPECT_LT(landing.soc_percent, sound.prediction->battery->expected.soc_percent - 20.0);
    EXPECT_LT(failing.battery->time_to_reserve_s.value(), 0.5 * sound.battery->time_to_reserve_s.value());
    EXPECT_GT(failing.battery->probability_below_reserve.value(), 0.1);
    EXPECT_LT(sound.battery->probability_below_reserve.value(), 1e-3);
    EXPECT_THAT(failing.warnings, testing::Contains(testing::HasSubstr("the prediction is by the voltage")));
    const auto alarm = std::ranges::find(failing.alarms, "voltage", &LiveAlarm::kind);
    ASSERT_NE(alarm, failing.alarms.end());
    EXPECT_THAT(alarm->text, testing::HasSubstr("the prediction is by the voltage"));
}

TEST(LiveFlight, RaisesAlarms) {
    const auto log = test::sample(1);
    const auto kinds_of = [&](PredictionInput basis, double silent_s, double volts_less) {
        LiveFlight flight(test::options_of(log), std::move(basis), nullptr);
        test::receive_all(flight, messages_with_less_voltage(log, volts_less));
        std::vector<std::string> kinds;
        for (const auto& alarm : flight.update(silent_s).alarms) kinds.push_back(alarm.kind);
        return kinds;
    };
    auto sound = test::wing_basis();
    sound.initial_soc_percent.reset();
    EXPECT_THAT(kinds_of(sound, 0.0, 0.0), testing::IsEmpty());
    EXPECT_THAT(kinds_of(sound, 31.0, 0.0), testing::ElementsAre("silence"));
    EXPECT_THAT(kinds_of(sound, 0.0, 0.6), testing::ElementsAre("voltage"));
    auto needy = test::wing_basis(2000.0);
    needy.limits.reserve_soc_percent = 60.0;
    EXPECT_THAT(kinds_of(needy, 0.0, 0.0), testing::Contains("reserve"));
    auto other = test::wing_basis();
    for (auto& phase : other.model.phases.values) phase.fourier.a0_w *= 2.0;
    EXPECT_THAT(kinds_of(other, 0.0, 0.0), testing::Contains("model"));
}

/// The chance is that of Student's t: half where the expected landing is just at the reserve.
TEST(LiveFlight, TheChanceOfLandingBelowTheReserveFollowsTheInterval) {
    const auto log = test::sample(1);
    const auto state_with = [&](double reserve_percent) {
        auto basis = test::wing_basis();
        basis.limits.reserve_soc_percent = reserve_percent;
        LiveFlight flight(test::options_of(log), basis, nullptr);
        test::receive_all(flight, test::messages_of(log, 400.0));
        return flight.update();
    };
    const auto state = state_with(0.0);
    const double expected = state.prediction->battery->expected.soc_percent;
    EXPECT_NEAR(state.battery->probability_below_reserve.value(), 0.0, 1e-9);
    EXPECT_NEAR(state_with(expected).battery->probability_below_reserve.value(), 0.5, 0.02);
    EXPECT_NEAR(
        state_with(state.prediction->battery->worst.soc_percent + 1e-6).battery->probability_below_reserve.value(),
        0.025, 0.006)
        << "of the interval's high end, where the battery's capacity has no interval";
    EXPECT_NEAR(state_with(99.0).battery->probability_below_reserve.value(), 1.0, 1e-9);
}

/// Against the sum over initial charges of the chances with each.
TEST(LiveFlight, TheChanceOfLandingBelowTheReserveHoldsTheInitialChargesSpread) {
    const auto messages = test::messages_of(test::sample(1), 400.0);
    const auto battery_with = [&](double reserve_percent, std::optional<double> initial_percent) {
        auto basis = test::wing_basis();
        basis.limits.reserve_soc_percent = reserve_percent;
        basis.initial_soc_percent = initial_percent;
        basis.battery->intervals.capacity_ah.reset();
        LiveFlight flight(test::options_of(test::sample(1)), basis, nullptr);
        test::receive_all(flight, messages);
        return flight.update();
    };
    const auto by_voltage = battery_with(0.0, std::nullopt);
    const auto [initial_percent, sd_percent] = by_voltage.battery->initial;
    ASSERT_GT(sd_percent, 0.5);
    const double expected = by_voltage.prediction->battery->expected.soc_percent;
    for (const double above_percent : {-2.0, 0.0, 2.0}) {
        double weights = 0.0;
        double chance = 0.0;
        for (int i = -9; i <= 9; ++i) {
            const double z = 0.4 * i;
            const double weight = std::exp(-0.5 * z * z);
            const auto given = battery_with(expected + above_percent, initial_percent + z * sd_percent);
            weights += weight;
            chance += weight * given.battery->probability_below_reserve.value();
        }
        const auto state = battery_with(expected + above_percent, std::nullopt);
        EXPECT_NEAR(state.battery->probability_below_reserve.value(), chance / weights, 0.02) << above_percent;
    }
}

/// Against the sum over capacities of the chances with each.
TEST(LiveFlight, TheChanceOfLandingBelowTheReserveHoldsTheCapacitysSpread) {
    const auto messages = test::messages_of(test::sample(1), 400.0);
    const auto battery_with = [&](double reserve_percent, double capacity_part, double sd_part) {
        auto basis = test::wing_basis();
        basis.limits.reserve_soc_percent = reserve_percent;
        const double capacity_ah = basis.battery->capacity_ah;
        constexpr double half_95 = 1.96;
        basis.battery->intervals.capacity_ah =
            Interval{capacity_ah * (1.0 - half_95 * sd_part), capacity_ah * (1.0 + half_95 * sd_part)};
        if (sd_part == 0.0) basis.battery->intervals.capacity_ah.reset();
        basis.battery->capacity_ah *= capacity_part;
        LiveFlight flight(test::options_of(test::sample(1)), basis, nullptr);
        test::receive_all(flight, messages);
        return flight.update();
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
                chance += weight * state.battery->probability_below_reserve.value();
            }
            const auto state = battery_with(reserve_percent, 1.0, sd_part);
            EXPECT_NEAR(state.battery->probability_below_reserve.value(), chance / weights, 0.02)
                << sd_part << " " << above_percent;
        }
    }
}

}  // namespace
}  // namespace flightwatt::live
