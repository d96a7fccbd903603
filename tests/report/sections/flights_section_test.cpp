#include "report/sections/flights_section.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportFlight sample_flight(const std::filesystem::path& file) {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(file));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    return flight;
}

TEST(FlightsSection, NamesEveryReasonOnceWithItsFlights) {
    auto whole = sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    auto one = sample_flight(test::hazards_dir() / "hazard_01_run-up.data");
    auto two = sample_flight(test::hazards_dir() / "hazard_01_two-sorties.data");
    for (auto* flight : {&one, &two}) {
        flight->unusable_power = "made for <segmentation>";
        flight->exclusions = {flight->name + ": it is excluded: made for <segmentation>"};
    }
    BatchContent batch;
    batch.flights = {whole, one, two};
    const auto section = flights_section(batch);
    EXPECT_THAT(section.html, HasSubstr("hazard_01_run-up, hazard_01_two-sorties"));
    EXPECT_THAT(section.html, HasSubstr(">it is excluded: made for &lt;segmentation&gt;<"));
    EXPECT_THAT(section.html, HasSubstr(">no</td>"));
    EXPECT_THAT(section.html, HasSubstr(">all</td>"));
    EXPECT_THAT(section.html, Not(HasSubstr(">in part</td>")));
    EXPECT_EQ(section.figures.size(), 3U) << "a figure over time each";
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
    return count;
}

TEST(FlightsSection, CompressesManyFlightsButTheFirst) {
    BatchContent batch;
    auto& flights = batch.flights;
    flights.assign(20, sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    for (std::size_t f = 0; f < flights.size(); ++f) flights[f].name = "flight_" + std::to_string(f);
    const auto few = flights_section(batch);
    EXPECT_THAT(few.html, Not(HasSubstr("class=\"block\"")));
    EXPECT_EQ(count_of(few.html, "data-spec="), 20U);

    auto rejected = flights.front();
    rejected.name = "flight_20";
    rejected.rejected = "it is made up";
    flights.insert(flights.begin(), rejected);
    const auto many = flights_section(batch);
    EXPECT_EQ(count_of(many.html, "<details class=\"flight\""), 20U);
    EXPECT_EQ(count_of(many.html, "class=\"block\""), 19U) << "the first one shown is open, and plain";
    EXPECT_EQ(count_of(many.html, "data-spec="), 1U);
    EXPECT_THAT(many.html, HasSubstr("they open with JavaScript"));
    EXPECT_EQ(many.figures.size(), few.figures.size()) << "files of figures hold all of them";
    EXPECT_EQ(many.figures.back().spec, few.figures.back().spec);
    EXPECT_LT(many.html.size(), few.html.size() / 3);
}

}  // namespace
}  // namespace flightwatt::report
