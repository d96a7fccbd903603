#include "flight/load_flight.h"
#include "helpers/test_paths.h"
#include "report/sections/sections.h"

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
    flight.series = flight::read_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    flight.phases = segment(flight.series);
    flight.name = flight.series.flight;
    return flight;
}

TEST(SummarySection, NamesSyntheticAircraftSo) {
    auto one = read_sample();
    auto other = one;
    other.series.aircraft_id = "8";
    other.series.aircraft_name = "Twinstar";
    auto rejected = one;
    rejected.rejected = "it is empty";
    const std::vector<ReportFlight> flights{one, other, rejected};
    EXPECT_THAT(aircraft_lines(flights),
                ElementsAre(StartsWith("7 Opterra_synthetic (SYNTHETIC): 1 flight on 2020-01-01, 10 min"),
                            StartsWith("8 Twinstar: 1 flight on ")));
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
    const auto html = summary_section(answers, std::vector<ReportFlight>{flight, rejected}).html;
    EXPECT_THAT(html, HasSubstr("1 flight of 2 (2 warnings); 1 log rejected"));
    EXPECT_THAT(html, HasSubstr("<li>landing: below 0 W</li>"));
    EXPECT_THAT(html, HasSubstr("<li>There is no model.</li>"));
    EXPECT_THAT(html, Not(HasSubstr("class=\"cards\""))) << "no missions";
}

TEST(PredictionLine, HasTheBestModelFirst) {
    const auto predicted = [](const std::string& model, double wh) {
        mechanical::FlightPrediction prediction{model, {}};
        prediction.phases[flight::Phase::cruise] = mechanical::EnergyEstimate{wh};
        return prediction;
    };
    mechanical::ValidatedFlight flight{"f", {}, {}, {predicted("fourier", 12.0), predicted("physical", 10.5)}};
    flight.measured_wh[flight::Phase::cruise] = 10.0;
    const std::vector flights{flight};
    const std::string errors =
        "Mean error of the energy of a flight that is not in the fit: 5.0 % (physical, airspeed known), 20.0 % "
        "(fourier); over 1 flight, each left out in turn";
    EXPECT_EQ(prediction_line(flights, true), errors + " (SYNTHETIC flights)");
    EXPECT_EQ(prediction_line(flights, false), errors);
    EXPECT_EQ(prediction_line({}, false), "");
}

}  // namespace
}  // namespace flightwatt::report
