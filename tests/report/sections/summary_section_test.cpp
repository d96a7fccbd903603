#include "report/sections/summary_section.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/paper_missions.h"
#include "helpers/test_paths.h"
#include "report/sections/aircraft_panel.h"
#include "report/sections/page_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

ReportFlight read_sample() {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    return flight;
}

TEST(SummarySection, NamesSyntheticAircraftSo) {
    auto one = read_sample();
    auto other = one;
    other.data.aircraft_id = "8";
    other.data.aircraft_name = "Twinstar";
    auto rejected = one;
    rejected.rejected = "it is empty";
    const std::vector<ReportFlight> flights{one, other, rejected};
    EXPECT_THAT(aircraft_lines(flights),
                ElementsAre(StartsWith("7 Opterra_synthetic (SYNTHETIC): 1 flight, 1 January 2020 \u00b7 10 min"),
                            StartsWith("8 Twinstar: 1 flight, ")));
    EXPECT_TRUE(any_synthetic(flights));
    EXPECT_FALSE(any_synthetic(std::span(flights).subspan(1)));
}

TEST(SummarySection, WarnsOfFlightsAndOfWhatIsMissing) {
    auto flight = read_sample();
    flight.warnings = {"a gap", "a spike"};
    auto rejected = read_sample();
    rejected.rejected = "it is empty";
    PageSummary answers;
    answers.warnings = {"landing: below 0 W"};
    answers.notes = {"There is no model."};
    const std::vector<ReportFlight> flights{flight, rejected};
    const auto html = summary_section(answers, flights).html;
    EXPECT_THAT(html, HasSubstr("2 warnings on 1 January 2020, 10:00</a>: a gap (and 1 more)"));
    EXPECT_THAT(html, HasSubstr("1 log</a> not used"));
    EXPECT_THAT(html, HasSubstr("<a href=\"#notes\">2 notes</a>"));
    EXPECT_THAT(html, Not(HasSubstr("<article"))) << "no missions";
    const auto notes = notes_section(answers);
    ASSERT_TRUE(notes);
    EXPECT_THAT(notes->html, HasSubstr("<li>landing: below 0 W</li>\n<li>There is no model.</li>"));
    EXPECT_FALSE(notes_section({}));
}

PageSummary answers_of(const std::vector<std::string>& names) {
    std::vector<mission::MissionVariant> missions;
    for (const auto& name : names) missions.emplace_back(test::paper_mission(name));
    PageSummary answers;
    answers.missions = simulate_for_report(missions);
    answers.answers.resize(names.size());
    return answers;
}

TEST(SummarySection, HasAHeadlineACardAndARowAMissionAndAllCurves) {
    const auto answers = answers_of({"invariant-32fps-448bit", "phased", "computing-only"});
    const auto html = summary_section(answers, {}).html;
    EXPECT_THAT(html, HasSubstr(">One of three missions runs empty</h1>"));
    EXPECT_THAT(html, HasSubstr("<article class=\"card mission fails\" id=\"mission-0\">"));
    EXPECT_THAT(html, HasSubstr("<article class=\"card mission may-miss\" id=\"mission-1\" hidden>"));
    EXPECT_THAT(html, HasSubstr("data-select=\"2\" aria-pressed=\"false\">computing-only</button>"));
    const std::string begin = "<script type=\"application/json\" id=\"data-missions\">";
    const auto at = html.find(begin) + begin.size();
    const auto data = VegaJson::parse(html.substr(at, html.find("</script>", at) - at));
    ASSERT_EQ(data.size(), 3U);
    EXPECT_EQ(data[1]["title"], "phased");
    EXPECT_EQ(data[1]["time_s"].size(), data[1]["soc"].size());
    EXPECT_EQ(data[1]["band"]["low"].size(), data[1]["band"]["high"].size());
    EXPECT_EQ(data[1]["phases"].size(), 3U);
    EXPECT_TRUE(data[0]["landing"].is_null()) << "it runs empty";
}

TEST(SummarySection, HasNoMissionAsPlannedWithTurnsThatAreTooSteep) {
    auto answers = answers_of({"computing-only", "computing-only"});
    EXPECT_THAT(summary_section(answers, {}).html, HasSubstr(">Both missions land as planned</h1>"));
    answers.missions.front().mission.setup.has_steep_turn = true;
    EXPECT_THAT(summary_section(answers, {}).html,
                HasSubstr(">One of two missions flies turns that it may not be able to</h1>"));
}

TEST(PageTitle, HasAircraftDatesAndCounts) {
    const auto flight = read_sample();
    EXPECT_EQ(page_title(std::vector{flight, flight}, 2),
              "7 Opterra_synthetic (SYNTHETIC): 2 flights, 1 January 2020; 2 missions");
    EXPECT_EQ(page_title({}, 0), "FlightWatt report");
}

TEST(PredictionLine, HasTheErrorsWithAndWithoutAirspeed) {
    const auto predicted = [](const std::string& model, double wh) {
        mechanical::FlightPrediction prediction{model, {}};
        prediction.phases[flight::Phase::cruise] = mechanical::EnergyEstimate{wh};
        return prediction;
    };
    mechanical::ValidatedFlight flight{"f", {}, {}, {predicted("constant_mean", 12.0), predicted("physical", 10.5)}};
    flight.measured_wh[flight::Phase::cruise] = 10.0;
    PageSummary answers;
    answers.validated = {flight};
    EXPECT_EQ(prediction_line(answers, true),
              "5 % off in total energy if the airspeed is known, 20 % if not. Each flight is predicted from the others "
              "(SYNTHETIC flights).");
    flight.predictions.pop_back();
    answers.validated = {flight};
    EXPECT_EQ(prediction_line(answers, false), "20 % off in total energy. Each flight is predicted from the others.");
    EXPECT_EQ(prediction_line({}, false), "");
}

}  // namespace
}  // namespace flightwatt::report
