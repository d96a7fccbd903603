// What watch states, of a state made by hand.

#include "cli/output/watch_output.h"

#include "live/live_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

compute::ComputeModel two_components() {
    compute::ComputeModel compute;
    compute.components.resize(2);
    compute.components[0].name = "detection";
    compute.components[0].profile.parameters = {"fps"};
    compute.components[1].name = "tx-2";
    return compute;
}

live::LiveState flying() {
    live::LiveState state;
    state.time_s = 400.0;
    state.aircraft_id = "7";
    state.phase = flight::Phase::cruise;
    state.flight_time_s = 300.0;
    state.energy_wh = 2.5;
    state.no_prediction_reason = "a model";
    state.decision.emplace();
    state.decision->run = {{0, {5.8}}};
    state.decision->next = compute::Configuration{{0, {32.0}}, {1, {}}};
    state.decision->next_in_s = 12.0;
    state.silence_threshold_s = 30.0;
    state.reserve_soc_percent = 20.0;
    state.alarms = {{"silence", "alarm", "nothing was received for 40 s", "Check antenna"}};
    return state;
}

TEST(WatchOutput, SaysWhatIsKnownAndWhatIsNot) {
    const auto line = line_of(flying(), two_components());
    EXPECT_THAT(line, HasSubstr("400 s  cruise 300 s  2.500 Wh  - W  - V  - m"));
    EXPECT_THAT(line, HasSubstr("no prediction: a model"));
    EXPECT_THAT(line, HasSubstr("runs detection fps=5.8, in 12 s detection fps=32, tx-2"));
    EXPECT_THAT(line, HasSubstr("ALARM: Check antenna (nothing was received for 40 s)"));
    const auto screen = screen_of(flying(), two_components());
    EXPECT_THAT(screen.back(), HasSubstr("ALARM"));
    const auto state = flying();
    const auto compute = two_components();
    const auto json = record_json(WatchState{&state, &compute});
    EXPECT_TRUE(json["prediction"].is_null());
    EXPECT_TRUE(json["power_w"].is_null());
    EXPECT_EQ(json["decision"]["run"]["detection"]["fps"], 5.8);
    EXPECT_EQ(json["decision"]["next_in_s"], 12.0);
    EXPECT_EQ(json["alarms"][0]["kind"], "silence");
    EXPECT_EQ(json["alarms"][0]["grade"], "alarm");
    EXPECT_EQ(json["alarms"][0]["action"], "Check antenna");
    EXPECT_EQ(json["silence_threshold_s"], 30.0);
    EXPECT_EQ(json["reserve_soc_percent"], 20.0);
}

TEST(WatchOutput, ShowsPowerVoltageAndAltitude) {
    auto state = flying();
    state.power_w = 27.14;
    state.expected_power_w = 25.0;
    state.voltage_v = 12.314;
    state.altitude_m = 96.6;
    state.alarms.front().grade = "caution";
    const auto line = line_of(state, two_components());
    EXPECT_THAT(line, HasSubstr("27.1 W (25.0 W expected)  12.31 V  97 m"));
    EXPECT_THAT(line, HasSubstr("Caution: Check antenna"));
    state.phase.reset();
    state.landed = true;
    EXPECT_THAT(line_of(state, two_components()), Not(HasSubstr("no prediction")));
}

TEST(WatchOutput, SaysWhenToTurnHome) {
    auto state = flying();
    state.battery.emplace();
    state.battery->time_to_reserve_s = 600.0;
    state.battery->probability_below_reserve = 0.031;
    state.turn_home = live::ReturnDeadline{90.0, false};
    EXPECT_THAT(
        line_of(state, two_components()),
        HasSubstr("reserve in 10.0 min of cruise, probability of landing below it 3.1 %, turn home within 1.5 min"));
    state.turn_home = live::ReturnDeadline{};
    EXPECT_THAT(line_of(state, two_components()), HasSubstr("too late to turn home"));
    const auto compute = two_components();
    EXPECT_TRUE(record_json(WatchState{&state, &compute})["turn_home"]["latest_in_s"].is_null());
    state.prediction.emplace();
    EXPECT_THAT(line_of(state, two_components()), HasSubstr("too late to land"));
    state.turn_home = live::ReturnDeadline{90.0, true};
    EXPECT_THAT(line_of(state, two_components()), HasSubstr("land within 1.5 min or finish as planned"));
    state.prediction->overtime_s = 60.0;
    EXPECT_THAT(line_of(state, two_components()), HasSubstr("Wh if it lands now"));
}

TEST(FreshWarnings, AreReportedOnceWhateverTheirNumbers) {
    std::set<std::string> reported;
    EXPECT_THAT(fresh_warnings({"1 gap, of 12 s"}, reported), ElementsAre("1 gap, of 12 s"));
    EXPECT_THAT(fresh_warnings({"2 gaps, of 12.5 s", "no wind"}, reported),
                ElementsAre("2 gaps, of 12.5 s", "no wind"));
    EXPECT_THAT(fresh_warnings({"3 gaps, of 40 s", "no wind"}, reported), testing::IsEmpty());
}

TEST(FreshWarnings, AreBounded) {
    std::set<std::string> reported;
    std::size_t fresh = 0;
    for (int i = 0; i < 1000; ++i)
        fresh += fresh_warnings({std::string(static_cast<std::size_t>(i) + 1, 'x')}, reported).size();
    EXPECT_EQ(fresh, 200U);
}

}  // namespace
}  // namespace flightwatt::cli
