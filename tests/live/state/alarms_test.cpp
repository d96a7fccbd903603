// Alarms of states made by hand.

#include "live/live_state.h"
#include "live/state/moment.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

/// In cruise, with a battery and a reserve of 20 %.
LiveState flying(double probability, const std::optional<double>& latest_in_s = 500.0) {
    LiveState state;
    state.phase = flight::Phase::cruise;
    state.silence_threshold_s = 30.0;
    state.battery.emplace();
    state.battery->probability_below_reserve = probability;
    state.turn_home = ReturnDeadline{latest_in_s, false};
    state.prediction.emplace();
    state.prediction->uses_physical_model = true;
    state.prediction->on_path_s = 100.0;
    state.prediction->flown.until_s = state.prediction->flown.cruise_start_s + 100.0;
    state.prediction->battery.emplace();
    state.prediction->battery->limits.reserve_soc_percent = 20.0;
    state.prediction->battery->expected.soc_percent = 23.4;
    return state;
}

/// The model has no variability, and raises no alarm.
PredictionInput input() {
    PredictionInput input;
    input.model.physical.emplace();
    return input;
}

TEST(AlarmsOf, AGradeEndsAtHalfOfItsThreshold) {
    std::vector<LiveAlarm> alarms;
    std::vector<std::string> grades;
    for (const double probability :
         {0.01, 0.04, 0.06, 0.03, 0.06, 0.02, 0.04, 0.05, 0.19, 0.20, 0.12, 0.21, 0.09, 0.15, 0.024, 0.3, 0.0}) {
        alarms = find_alarms(flying(probability), input(), alarms);
        grades.push_back(alarms.empty() ? "-" : alarms.front().grade);
    }
    EXPECT_THAT(grades, testing::ElementsAre("-", "-", "caution", "caution", "caution", "-", "-", "caution", "caution",
                                             "alarm", "alarm", "alarm", "caution", "caution", "-", "alarm", "-"));
}

TEST(AlarmsOf, PowerThatEndsIsASilence) {
    auto state = flying(0.0);
    state.time_without_power_s = 40.0;
    const auto alarms = find_alarms(state, input(), {});
    ASSERT_EQ(alarms.size(), 1U);
    EXPECT_EQ(alarms.front().kind, "silence");
    EXPECT_EQ(alarms.front().grade, "alarm");
    EXPECT_THAT(alarms.front().text, testing::StartsWith("no power was received for 40 s"));
}

/// The alarm ended with the landing, and the page stated the charge left by the counter alone.
TEST(AlarmsOf, AVoltageThatIsTooLowIsACautionOnTheGround) {
    auto state = flying(0.0);
    state.battery->voltage_residual_v = -0.4;
    const auto in_air = find_alarms(state, input(), {});
    ASSERT_EQ(in_air.size(), 1U);
    EXPECT_EQ(in_air.front().grade, "alarm");
    EXPECT_THAT(in_air.front().action, testing::StartsWith("Turn home and land: "));
    state.phase.reset();
    state.prediction.reset();
    state.battery->voltage_residual_v = -0.2;
    const auto landed = find_alarms(state, input(), in_air);
    ASSERT_EQ(landed.size(), 1U);
    EXPECT_EQ(landed.front().grade, "caution");
    EXPECT_THAT(landed.front().action, testing::StartsWith("Do not take off: "));
    EXPECT_THAT(find_alarms(state, input(), {}), testing::IsEmpty()) << "half of the threshold";
}

/// A pack that is colder or older than the mean of its flights was called a failing cell.
TEST(AlarmsOf, AVoltageThatAnotherResistanceExplainsIsNone) {
    auto state = flying(0.0);
    state.battery->voltage_residual_v = -0.4;
    state.battery->voltage_explained_v = 0.45;
    EXPECT_THAT(find_alarms(state, input(), {}), testing::IsEmpty());
    state.battery->voltage_residual_v = -0.5;
    EXPECT_EQ(find_alarms(state, input(), {}).size(), 1U);
}

TEST(AlarmsOf, AProbabilityThatVariesAroundAThresholdRaisesOneAlarm) {
    std::vector<LiveAlarm> alarms;
    int changes = 0;
    for (int second = 0; second < 600; ++second) {
        const bool had = !alarms.empty();
        alarms = find_alarms(flying(0.05 + (second % 2 == 0 ? 0.02 : -0.02)), input(), alarms);
        changes += had != !alarms.empty() ? 1 : 0;
    }
    EXPECT_EQ(changes, 1);
}

std::string action_of(const LiveState& state) {
    const auto alarms = find_alarms(state, input(), {});
    return alarms.empty() ? "" : alarms.front().action;
}

TEST(AlarmsOf, TheActionStatesTheTimeLeft) {
    EXPECT_EQ(action_of(flying(0.97, 175.0)), "Turn home within 2 min: the reserve will be missed");
    EXPECT_EQ(action_of(flying(0.97, 50.0)), "Turn home within 50 s: the reserve will be missed");
    EXPECT_EQ(action_of(flying(0.97, std::nullopt)), "Turn home now: the reserve will be missed");
    EXPECT_EQ(action_of(flying(0.16)), "Turn home within 8 min: 16 of 100 flights miss the reserve");
    auto state = flying(0.3);
    state.turn_home->path_can_be_flown = true;
    EXPECT_EQ(action_of(state), "Shorten the cruise: 30 of 100 flights miss the reserve");
    state = flying(0.3);
    state.prediction->on_path_s.reset();
    EXPECT_EQ(action_of(state), "Land within 8 min: 30 of 100 flights miss the reserve");
    state.prediction->battery->limits.reserve_soc_percent = 0.0;
    EXPECT_EQ(action_of(state), "Land within 8 min: 30 of 100 flights run empty");
    state.turn_home.reset();
    EXPECT_EQ(action_of(state), "Land now: 30 of 100 flights run empty");
    EXPECT_EQ(find_alarms(flying(0.97), input(), {}).front().text,
              "23.4 % at landing, reserve 20 %; probability of missing it 97 %");
}

/// "Land now" was the action from the lift-off of a mission that is too long, with 8 min to the reserve.
TEST(AlarmsOf, AClimbWithTimeForACruiseNeedsNoLandingNow) {
    auto state = flying(0.99);
    state.phase = flight::Phase::takeoff;
    state.turn_home.reset();
    state.prediction->on_path_s.reset();
    state.prediction->landing_s = 40.0;
    state.battery->time_to_reserve_s = 161.0;
    EXPECT_EQ(action_of(state), "Shorten the cruise: the reserve will be missed");
    for (const auto& reserve_in_s : {std::optional(159.0), std::optional<double>()}) {
        state.battery->time_to_reserve_s = reserve_in_s;
        EXPECT_EQ(action_of(state), "Land now: the reserve will be missed");
    }
}

/// Where the prediction ended, an alarm of over 99 % ended as well, and its end was announced.
TEST(AlarmsOf, AnAlarmOfTheReserveStaysWhileTheLandingIsUnknown) {
    const auto raised = find_alarms(flying(0.9), input(), {});
    ASSERT_EQ(raised.size(), 1U);
    auto state = flying(0.9);
    state.prediction.reset();
    EXPECT_THAT(find_alarms(state, input(), {}), testing::IsEmpty());
    for (const bool has_battery : {true, false}) {
        if (!has_battery) state.battery.reset();
        const auto held = find_alarms(state, input(), raised);
        ASSERT_EQ(held.size(), 1U);
        EXPECT_EQ(held.front().kind, "reserve");
        EXPECT_EQ(held.front().grade, "alarm");
        EXPECT_EQ(held.front().text, "the charge at landing is unknown at present");
    }
    state.phase.reset();
    EXPECT_THAT(find_alarms(state, input(), raised), testing::IsEmpty()) << "it has landed";
}

TEST(AlarmsOf, AChargeBelowTheReserveIsAnAlarmWithoutAPrediction) {
    auto state = flying(0.0);
    state.prediction.reset();
    auto of = input();
    of.limits.reserve_soc_percent = 20.0;
    state.battery->soc_by_voltage_percent = 19.0;
    const auto alarms = find_alarms(state, of, {});
    ASSERT_EQ(alarms.size(), 1U);
    EXPECT_EQ(alarms.front().action, "Land now: the charge is below the reserve");
    state.battery->soc_percent = 25.0;
    EXPECT_THAT(find_alarms(state, of, {}), testing::IsEmpty()) << "what was counted goes before the voltage";
}

/// Of a second flight, what is kept began in the first one: its charge was unknown, without a word.
TEST(RetentionStart, IsInTheRestBeforeTheFlight) {
    flight::FlightPhases phases;
    phases.sorties.resize(2);
    const auto fly = [&](std::size_t sortie, double from_s, double to_s) {
        auto& cruise = phases.sorties[sortie].phases.emplace_back();
        cruise.phase = flight::Phase::cruise;
        cruise.start.time_s = from_s;
        cruise.end.time_s = to_s;
    };
    fly(0, 100.0, 900.0);
    fly(1, 970.0, 1500.0);
    LiveState state;
    state.time_s = 1500.0;
    state.phase = flight::Phase::cruise;
    EXPECT_EQ(retention_start_s(phases, state), 935.0);
    phases.sorties[0].phases.clear();
    fly(0, 100.0, 200.0);
    EXPECT_EQ(retention_start_s(phases, state), 670.0);
    phases.sorties.erase(phases.sorties.begin());
    EXPECT_EQ(retention_start_s(phases, state), 670.0);
}

TEST(AlarmsOf, WithoutAProbabilityTheExpectedLandingDecides) {
    auto state = flying(0.0);
    state.battery->probability_below_reserve.reset();
    EXPECT_EQ(action_of(state), "");
    state.prediction->battery->expected.keeps_reserve = false;
    EXPECT_EQ(find_alarms(state, input(), {}).front().grade, "alarm");
}

TEST(AlarmsOf, ACruiseBeyondTheMissionsWarnsBeforeItIsTooLate) {
    auto state = flying(0.0, 130.0);
    state.prediction->overtime_s = 60.0;
    EXPECT_EQ(action_of(state), "");
    state.turn_home->latest_in_s = 110.0;
    EXPECT_EQ(find_alarms(state, input(), {}).front().grade, "caution");
    EXPECT_EQ(action_of(state), "Turn home within 1 min: later the reserve is missed");
}

TEST(AlarmsOf, OtherKindsHaveGradesAndActions) {
    auto state = flying(0.06);
    state.time_since_message_s = 31.0;
    state.battery->voltage_residual_v = -0.4;
    const auto alarms = find_alarms(state, input(), {});
    std::vector<std::string> kinds;
    for (const auto& alarm : alarms) {
        kinds.push_back(alarm.grade + " " + alarm.kind);
        EXPECT_THAT(alarm.action, testing::Not(testing::IsEmpty()));
    }
    EXPECT_THAT(kinds, testing::ElementsAre("alarm silence", "alarm voltage", "caution reserve"));
    state.battery->voltage_residual_v = -0.2;
    EXPECT_EQ(find_alarms(state, input(), alarms).size(), 3U) << "above half of the threshold";
    EXPECT_EQ(find_alarms(state, input(), {}).size(), 2U);
    LiveState ground;
    ground.time_since_message_s = 31.0;
    ground.silence_threshold_s = 30.0;
    EXPECT_EQ(find_alarms(ground, {}, {}).front().grade, "caution") << "the aircraft was switched off";
}

TEST(AlarmsOf, APowerOutsideTheModelsIntervalIsACaution) {
    auto state = flying(0.0);
    auto model = input();
    model.model.physical->level_sd = 0.05;
    model.model.physical->degrees_of_freedom = 1e6;
    state.prediction->flown.motion.bins.resize(1);
    state.prediction->cruise.gain = 0.09;
    EXPECT_TRUE(find_alarms(state, model, {}).empty());
    state.prediction->cruise.gain = 0.11;
    const auto alarms = find_alarms(state, model, {});
    ASSERT_EQ(alarms.size(), 1U);
    EXPECT_EQ(alarms.front().grade + " " + alarms.front().kind, "caution model");
}

}  // namespace
}  // namespace flightwatt::live
