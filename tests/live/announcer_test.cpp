#include "live/announcer.h"

#include "telemetry/mavlink_decoder.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// "HEARTBEAT", "fw_land 23.5", "4 text" of each packet.
std::vector<std::string> announced(Announcer& announcer, const LiveState& state, double now_s) {
    std::vector<std::string> announced;
    for (const auto& packet : announcer.packets(state, now_s)) {
        const auto read = telemetry::read_mavlink_packet(packet).value();
        const auto& name = read.name;
        EXPECT_EQ(read.system, 7);
        EXPECT_EQ(read.component, 191);
        if (name == "NAMED_VALUE_FLOAT")
            announced.push_back(read.text + " " + std::to_string(std::lround(10.0 * read.of.at("value"))));
        else if (name == "STATUSTEXT")
            announced.push_back(std::to_string(std::lround(read.of.at("severity"))) + " " + read.text);
        else
            announced.push_back(name);
    }
    return announced;
}

LiveState predicted_state() {
    LiveState state;
    state.prediction.emplace();
    state.prediction->battery.emplace();
    state.prediction->battery->expected.soc_percent = 23.5;
    state.battery.emplace();
    state.battery->time_to_reserve_s = 600.0;
    state.turn_home = ReturnDeadline{90.0, false};
    return state;
}

TEST(Announcer, SendsKnownValuesOnceASecond) {
    Announcer announcer(7, 191);
    auto state = predicted_state();
    EXPECT_THAT(announced(announcer, state, 0.0), ElementsAre("HEARTBEAT", "fw_land 235", "fw_home 15", "fw_resv 100"));
    EXPECT_THAT(announced(announcer, state, 0.9), IsEmpty());
    state.turn_home->latest_in_s.reset();
    state.battery->time_to_reserve_s.reset();
    EXPECT_THAT(announced(announcer, state, 1.0), ElementsAre("HEARTBEAT", "fw_land 235", "fw_home 0"))
        << "too late: now";
    EXPECT_THAT(announced(announcer, LiveState{}, 2.0), ElementsAre("HEARTBEAT")) << "nothing is known";
    state.alarms = {{"silence", "alarm", "", ""}};
    announced(announcer, state, 2.5);
    EXPECT_THAT(announced(announcer, state, 3.0), ElementsAre("HEARTBEAT")) << "what is known is old";
    state.alarms.clear();
    state.landed = true;
    EXPECT_THAT(announced(announcer, state, 4.0), testing::Contains("HEARTBEAT"));
    EXPECT_THAT(announced(announcer, state, 5.0), ElementsAre("HEARTBEAT"));
}

TEST(Announcer, SendsEachChangeOfAnAlarmsGrade) {
    Announcer announcer(7, 191);
    LiveState state;
    announced(announcer, state, 0.0);
    state.alarms = {{"reserve", "caution", "", "turn home within 4 min, or the reserve will be missed at landing"}};
    EXPECT_THAT(announced(announcer, state, 0.1), ElementsAre("4 FlightWatt caution: turn home within 4 min, or the"));
    EXPECT_THAT(announced(announcer, state, 0.2), IsEmpty()) << "it did not change";
    state.alarms[0].grade = "alarm";
    EXPECT_THAT(announced(announcer, state, 0.3), ElementsAre("2 FlightWatt alarm: turn home within 4 min, or the"));
    state.alarms[0].grade = "caution";
    EXPECT_THAT(announced(announcer, state, 0.4), IsEmpty()) << "one that falls again at once is not announced";
    state.alarms.clear();
    EXPECT_THAT(announced(announcer, state, 6.0), ElementsAre("HEARTBEAT", "5 FlightWatt: no reserve alarm any more"));
    EXPECT_THAT(announced(announcer, state, 6.5), IsEmpty());
}

/// An alarm of one grade was announced as "Turn home within 6 min" alone, and "now" never.
TEST(Announcer, SendsWhatAnAlarmAsksForWhereThatChanges) {
    Announcer announcer(7, 191);
    LiveState state;
    std::vector<std::string> texts;
    for (int now_s = 0; now_s < 200; ++now_s) {
        const int left_s = 150 - now_s;
        const auto request = left_s < 10   ? std::string("now")
                             : left_s < 60 ? fmt::format("within {} s", left_s)
                                           : fmt::format("within {} min", left_s / 60);
        state.alarms = {{"reserve", "alarm", "", "Turn home " + request + ": the reserve will be missed"}};
        for (const auto& text : announced(announcer, state, now_s))
            if (text.starts_with("2 ")) texts.push_back(fmt::format("{} {}", now_s, text.substr(2)));
    }
    EXPECT_THAT(texts,
                ElementsAre("0 FlightWatt alarm: Turn home within 2 min", "91 FlightWatt alarm: Turn home within 59 s",
                            "141 FlightWatt alarm: Turn home now"));
}

/// "Land now: the reserve will be" was all that fitted.
TEST(Announcer, LeavesOutAReasonThatDoesNotFit) {
    Announcer announcer(7, 191);
    LiveState state;
    announced(announcer, state, 0.0);
    state.alarms = {{"reserve", "alarm", "", "Turn home within 12 min: the reserve will be missed"},
                    {"silence", "alarm", "", "Turn home: the charge is unknown"}};
    EXPECT_THAT(announced(announcer, state, 0.1), ElementsAre("2 FlightWatt alarm: Turn home within 12 min",
                                                              "2 FlightWatt alarm: Turn home: the charge is unknown"));
}

}  // namespace
}  // namespace flightwatt::live
