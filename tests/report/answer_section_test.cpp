// The page of an answer begins with what the terminal shows.

#include "report/answer_section.h"

#include <regex>

#include <boost/algorithm/string/replace.hpp>
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

/// Words of the section's part from `begin` to `end`, in order.
std::string words(const std::string& html, const std::string& begin, const std::string& end) {
    const auto from = html.find(begin);
    auto text = std::regex_replace(html.substr(from, html.find(end) - from), std::regex("</d[td]>|</h1>"), "\n");
    text = std::regex_replace(text, std::regex("<[^>]*>"), "");
    for (const auto& [entity, character] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&#39;", "'"}, {"&amp;", "&"}})
        boost::replace_all(text, entity, character);
    return std::regex_replace(text, std::regex("\\s+"), " ");
}

TEST(AnswerSection, HasTheLinesOfTheTerminalWithoutItsFiles) {
    for (const bool is_answered : {true, false}) {
        auto answer = some_answer();
        if (!is_answered) answer.no_answer = "no flight has measured power";
        auto terminal = answer_text(answer, 10000);
        terminal = std::regex_replace(terminal, std::regex("; written by [^\n]*"), "");
        const auto html = answer_section(answer, {}).html;
        EXPECT_EQ(words(html, "<h1", "</dl>"), std::regex_replace(terminal, std::regex("\\s+"), " "));
        EXPECT_THAT(html, Not(HasSubstr("/home")));
    }
}

TEST(AnswerSection, SetsValuesOffFromWhatTheyRestOn) {
    const auto html = answer_section(some_answer(), {{"ArduPilot", "BATT_LOW_MAH 3\n# <x>\n"}}).html;
    EXPECT_THAT(html, HasSubstr("<dt>Cruise</dt><dd><b>413 W</b> (measured on 3 flights)</dd>"));
    EXPECT_THAT(html, HasSubstr("<dt>Distance</dt><dd><b>unknown</b>: no log has an airspeed; one with it"));
    EXPECT_THAT(html, HasSubstr("<summary>ArduPilot</summary>\n<pre>BATT_LOW_MAH 3\n# &lt;x&gt;\n</pre>"));
}

}  // namespace
}  // namespace flightwatt::report
