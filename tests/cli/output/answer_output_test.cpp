#include "cli/output/answer_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using answer::known;
using testing::HasSubstr;
using testing::Not;

AircraftAnswer answered() {
    AircraftAnswer answer;
    answer.endurance.power_w = known(400.0, "measured on 3 flights");
    answer.endurance.airspeed_m_per_s = known(12.0, "measured in cruise");
    answer.endurance.return_airspeed_m_per_s = answer.endurance.airspeed_m_per_s;
    answer.endurance.distance_m = known(9000.0, "measured in cruise");
    auto& card = answer.failsafe.emplace();
    card.home_distance_m = 500.0;
    auto& low = card.low.emplace();
    low.soc_percent = 39;
    low.remaining_mah = 2307;
    low.too_late = 0.049;
    low.voltage = {14.16, 0.123, 0.0};
    card.critical.soc_percent = 21;
    card.critical.remaining_mah = 1209;
    card.critical.too_late = 0.01;
    return answer;
}

std::string text_of(const AircraftAnswer& answer) { return answer_text(answer, 1000); }

TEST(AnswerText, EachActionHasItsOwnChanceOfBeingTooLate) {
    auto answer = answered();
    EXPECT_THAT(text_of(answer),
                HasSubstr("return at 39 % or 2307 mAh left (too late in 4.9 of 100 flights), and "
                          "at 14.16 V in cruise (alone too late in 12.3), from 500 m; land at 21 % or 1209 mAh "
                          "left (too late in 1 of 100 flights); written by"));
    answer.failsafe->chances_known = false;
    for (auto* action : {&*answer.failsafe->low, &answer.failsafe->critical}) action->too_late.reset();
    EXPECT_THAT(text_of(answer), HasSubstr("1209 mAh left; chances unknown: two more flights would show"));
    answer.endurance.time_95_s = answer::unknown("the model does not show it");
    EXPECT_THAT(text_of(answer), HasSubstr("chances unknown: the model does not show it; written by"));
}

TEST(AnswerText, FailsafeIsWrittenForTheAutopilotOfTheLogsAndTheWayHome) {
    auto answer = answered();
    EXPECT_THAT(text_of(answer), HasSubstr("--format failsafe-ardupilot --home-distance 500 --airspeed 12.00 (or -px4, "
                                           "-inav, -paparazzi)"));
    answer.name = "PX4";
    EXPECT_THAT(text_of(answer), HasSubstr("--format failsafe-px4 --home-distance 500 --airspeed 12.00 (or -ardupilot, "
                                           "-inav, -paparazzi)"));
    answer.name = "INAV";
    EXPECT_THAT(text_of(answer),
                HasSubstr("--format failsafe-inav --home-distance 500 --airspeed 12.00 (or -ardupilot, "
                          "-px4, -paparazzi)"));
    answer.folder = "my flights/out";
    EXPECT_THAT(text_of(answer), HasSubstr("flightwatt export 'my flights/out/answer-mission.toml' --format"));
    answer.failsafe->low.reset();
    answer.failsafe->low_missing = "12 m/s make no way home";
    EXPECT_THAT(text_of(answer), HasSubstr("failsafe-inav --home-distance 500")) << "or the file has another reason";
}

TEST(AnswerText, AReasonWithoutASubjectIsThatOfTheLog) {
    AircraftAnswer answer;
    answer.no_answer = "has no flight in 4 s; no motion";
    EXPECT_THAT(text_of(answer), HasSubstr("No answer the log has no flight in 4 s; no motion"));
    answer.no_answer = "is no log that is known";
    EXPECT_THAT(text_of(answer), HasSubstr("No answer the file is no log that is known"));
    answer.no_answer = "no flight has measured power";
    EXPECT_THAT(text_of(answer), HasSubstr("No answer no flight has measured power"));
}

TEST(AnswerText, AssumedSpeedOfTheWayHomeIsNamed) {
    auto answer = answered();
    EXPECT_THAT(text_of(answer), Not(HasSubstr("from 500 m at")));
    answer.endurance.return_airspeed_m_per_s = known(8.0, "assumed: 2.0 m/s over ground as in the flights");
    EXPECT_THAT(text_of(answer), HasSubstr("from 500 m at 8.0 m/s (assumed: 2.0 m/s over ground as in the flights);"));
    EXPECT_THAT(text_of(answer), HasSubstr("--airspeed 8.00"));
}

TEST(AnswerText, DirectionOfTheWindMakesTheCourses) {
    auto answer = answered();
    EXPECT_THAT(text_of(answer), HasSubstr("9.0 km in all, out and back in calm air (measured"));
    answer.question.wind_m_per_s = 6.0;
    answer.endurance.distance_across_m = 10400.0;
    EXPECT_THAT(text_of(answer), HasSubstr("along a wind of 6.0 m/s; 10.4 km across it (measured"));
    answer.question.wind_from_deg = 250.0;
    EXPECT_THAT(text_of(answer), HasSubstr("along a wind of 6.0 m/s (70 and 250 degrees); 10.4 km across it (160 and "
                                           "340 degrees)"));
}

TEST(AnswerText, TemperatureOfThePackIsThatOfTheLogs) {
    auto answer = answered();
    answer.pack.resistance_ohm = known(0.02, "measured on 3 flights");
    EXPECT_THAT(text_of(answer), HasSubstr("20 mOhm; temperature unknown: the logs state none"));
    answer.pack.air_temperature_c = Interval{4.0, 12.0};
    EXPECT_THAT(text_of(answer), HasSubstr("in air of 4 to 12 degC, other temperatures unknown"));
    answer.pack.battery_start_c = Interval{21.0, 29.0};
    EXPECT_THAT(text_of(answer), HasSubstr("20 mOhm; at 21 to 29 degC of the battery at take-off (measured)\n"));
    answer.pack.asked_temperature_c = -5.0;
    answer.pack.resistance_at_ohm = known(0.04, "assumed: 3 %");
    answer.pack.resistance_at_interval_ohm = Interval{0.02, 0.06};
    EXPECT_THAT(text_of(answer), HasSubstr("(measured); at -5 degC 40 mOhm (20 to 60), assumed: 3 %"));
    answer.pack.resistance_at_ohm = answer::unknown("the effect of -5 degC is unknown");
    EXPECT_THAT(text_of(answer), HasSubstr("(measured); the effect of -5 degC is unknown\n"));
}

}  // namespace
}  // namespace flightwatt::cli
