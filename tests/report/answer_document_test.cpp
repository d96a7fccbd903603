// The document of an answer has what the terminal shows.

#include "report/answer_document.h"

#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

cli::AircraftAnswer some_answer() {
    cli::AircraftAnswer answer;
    answer.aircraft = "7";
    answer.name = "<Opterra>";
    answer.folder = "/home/pilot/out";
    answer.logs = answer.used = 3;
    answer.endurance.power_w = answer::known(413.0, "measured on 3 flights");
    answer.endurance.time_s = answer::known(612.0, "physics");
    answer.endurance.time_95_s = answer::unknown("one flight");
    answer.endurance.distance_m = answer::unknown("no log has an airspeed; one with it would show it");
    answer.endurance.notes = {"a note", "another"};
    answer.pack.capacity_ah = answer::known(6.0, "as given");
    answer.pack.resistance_ohm = answer::unknown("too few flights");
    answer.prediction_error_percent = answer::unknown("a second flight would show it");
    answer.failsafe = answer::FailsafeCard{};
    return answer;
}

TEST(AnswerDocument, HasTheLinesOfTheTerminalWithoutItsFiles) {
    for (const bool is_answered : {true, false}) {
        auto answer = some_answer();
        if (!is_answered) answer.no_answer = "no flight has measured power";
        auto terminal = answer_text(answer, 10000);
        terminal = std::regex_replace(terminal, std::regex("; written by [^\n]*"), "");
        const auto json = answer_json(answer, {});
        auto text = json["headline"].get<std::string>();
        for (const auto& line : json["lines"])
            for (const auto* part : {"label", "value", "basis"})
                text += (part == std::string("basis") ? "" : " ") + line[part].get<std::string>();
        const auto words = [](const std::string& of) { return std::regex_replace(of, std::regex("\\s+"), " "); };
        EXPECT_EQ(words(text + "\n"), words(terminal));
        EXPECT_THAT(json.dump(), Not(HasSubstr("/home")));
    }
}

TEST(AnswerDocument, SetsValuesOffFromWhatTheyRestOn) {
    const auto json = answer_json(some_answer(), {{"ArduPilot", "BATT_LOW_MAH 3\n"}});
    EXPECT_EQ(json["lines"][0], Json::parse(R"({"label": "Cruise", "value": "413 W", "basis": " (measured on 3 flights)"
})"));
    EXPECT_EQ(json["lines"][2]["value"], "unknown");
EXPECT_EQ(json["pastes"], Json::parse(R"([{"name": "ArduPilot", "text": "BATT_LOW_MAH 3\n"}])"));
EXPECT_EQ(json["time_in_air_s"]["value"], 612.0) << "as flightwatt answer prints it";
}

}  // namespace
}  // namespace flightwatt::report
