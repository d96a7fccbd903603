#include "report/document/aircraft_panel.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::StartsWith;

ReportFlight read_sample() {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    flight.facts = summarize_flight(flight);
    return flight;
}

TEST(AircraftLines, NameSyntheticAircraftSo) {
    auto one = read_sample();
    auto other = one;
    other.data.aircraft_id = "8";
    other.data.aircraft_name = "Twinstar";
    auto rejected = one;
    rejected.rejected = "it is empty";
    const std::vector<ReportFlight> flights{one, other, rejected};
    const auto lines = aircraft_lines(flights);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].name, "7 Opterra_synthetic (SYNTHETIC)");
    EXPECT_THAT(lines[0].text, StartsWith("1 flight, 1 January 2020 \u00b7 10 min"));
    EXPECT_EQ(lines[1].name, "8 Twinstar");
    EXPECT_TRUE(any_synthetic(flights));
    EXPECT_FALSE(any_synthetic(std::span(flights).subspan(1)));
}

TEST(AircraftPanel, HasPowersFactsAndWarnings) {
    auto flight = read_sample();
    flight.warnings = {"a gap", "a spike"};
    auto rejected = read_sample();
    rejected.rejected = "it is empty";
    const std::vector<ReportFlight> flights{rejected, flight};
    const auto panel = aircraft_panel({}, flights);
    ASSERT_EQ(panel["phases"].size(), 3U);
    EXPECT_EQ(panel["phases"][0]["phase"], "takeoff");
    EXPECT_EQ(panel["facts"][0]["name"], "Energy for a minute of cruise");
    EXPECT_EQ(panel["warned_flights"], Json::parse(R"([{"flight": 1, "text": "a gap", "warnings": 2}])"));
    EXPECT_EQ(panel["rejected_logs"], 1);
    EXPECT_EQ(flight_title(flight), "1 January 2020, 10:00");
    EXPECT_TRUE(aircraft_panel({}, {}).is_null());
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
    Findings answers;
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
