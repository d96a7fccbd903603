#include "report/flights_section.h"

#include "flight/load_flight.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportFlight sample_flight(const std::string& path) {
    ReportFlight flight;
    flight.series = flight::read_flight(test::source_dir() / (path + ".data"));
    flight.phases = segment(flight.series);
    flight.name = flight.series.flight;
    return flight;
}

TEST(FlightsSection, NamesEveryReasonOnceWithItsFlights) {
    auto whole = sample_flight("logs/opterra_synthetic_01");
    auto one = sample_flight("tests/data/hazards/hazard_01_run-up");
    auto two = sample_flight("tests/data/hazards/hazard_01_two-sorties");
    for (auto* flight : {&one, &two}) {
        flight->unusable_power = "made for <segmentation>";
        flight->exclusions = {flight->name + ": it is excluded: made for <segmentation>"};
    }
    const std::vector<ReportFlight> flights{whole, one, two};
    const auto section = flights_section(flights, std::nullopt);
    EXPECT_THAT(section.html, HasSubstr("hazard_01_run-up, hazard_01_two-sorties"));
    EXPECT_THAT(section.html, HasSubstr(">it is excluded: made for &lt;segmentation&gt;<"));
    EXPECT_THAT(section.html, HasSubstr(">no</td>"));
    EXPECT_THAT(section.html, HasSubstr(">all</td>"));
    EXPECT_THAT(section.html, Not(HasSubstr(">in part</td>")));
    EXPECT_EQ(section.figures.size(), 6U) << "a figure over time and a track each";
}

}  // namespace
}  // namespace flightwatt::report
