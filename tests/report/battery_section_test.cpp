#include "report/battery_section.h"

#include "base/error.h"
#include "helpers/synthetic_discharge.h"
#include "report/figures/flight_figures.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

ReportFlight flight_on(const battery::Battery& pack, std::uint64_t seed) {
    ReportFlight flight;
    flight.series = test::synthetic_discharge(pack, {}, seed);
    flight.name = flight.series.flight;
    return flight;
}

std::vector<ReportFlight> flights_on(const battery::Battery& pack, std::uint64_t count) {
    std::vector<ReportFlight> flights;
    for (std::uint64_t seed = 1; seed <= count; ++seed) flights.push_back(flight_on(pack, seed));
    return flights;
}

battery::IdentificationOptions with_capacity(const battery::Battery& pack) {
    battery::IdentificationOptions options;
    options.capacity_ah = pack.capacity_ah;
    return options;
}

TEST(BatterySection, ShowsVoltagesParametersAndTheCurve) {
    const auto pack = test::known_pack();
    const auto battery = identify_for_report(flights_on(pack, 2), with_capacity(pack), 12);
    ASSERT_TRUE(battery.identified) << battery.no_answer;
    EXPECT_EQ(battery.leave_one_out.size(), 2U);
    const auto section = battery_section(battery);
    ASSERT_EQ(section.figures.size(), 2U);
    EXPECT_EQ(section.figures[0].spec["concat"].size(), 2U);
    const auto rows = section.figures[0].spec["concat"][0]["layer"][0]["data"]["values"].get<std::string>();
    for (const auto* curve : {",measured", ",model"}) EXPECT_THAT(rows, HasSubstr(curve));
    const auto knots = section.figures[1].spec["data"]["values"].get<std::string>();
    EXPECT_EQ(static_cast<std::size_t>(std::count(knots.begin(), knots.end(), '\n')),
              battery.identified->battery.thevenin->open_circuit.soc_percent.size());
    EXPECT_THAT(section.html, HasSubstr("resistance_ohm"));
    EXPECT_THAT(section.html, HasSubstr("identified from voltage, current and charge of 2 flights"));
    EXPECT_THAT(section.html, testing::Not(HasSubstr("Not used for the battery")));
    const auto tables = battery_tables(battery);
    ASSERT_EQ(tables.size(), 3U);
    EXPECT_EQ(tables[1].table.rows.size(), 2U) << "flights";
    EXPECT_TRUE(tables[2].table.rows.empty()) << "excluded";
}

TEST(BatterySection, LimitsTheFlightsAndSaysSo) {
    const auto pack = test::known_pack();
    const auto battery = identify_for_report(flights_on(pack, 5), with_capacity(pack), 2);
    EXPECT_EQ(battery.usable, 5U);
    ASSERT_EQ(battery.records.size(), 2U);
    EXPECT_EQ(battery.records[0].flight, "synthetic_1");
    EXPECT_EQ(battery.records[1].flight, "synthetic_5");
    EXPECT_THAT(battery_section(battery).html, HasSubstr("among the 5 that could be used"));
}

TEST(BatterySection, SaysWhyThereIsNone) {
    const auto pack = test::known_pack();
    auto computed = flight_on(pack, 1);
    computed.series.current_origin = flight::CurrentOrigin::throttle;
    auto voltless = flight_on(pack, 2);
    std::erase_if(voltless.series.tracks, [](const auto& track) { return track.name == "voltage_v"; });
    auto faulty = flight_on(pack, 3);
    faulty.unusable_power = "its power record is <faulty>";
    ReportFlight rejected;
    rejected.name = "rejected";
    rejected.rejected = "no flight in it";
    const std::vector<ReportFlight> flights{computed, voltless, faulty, rejected};
    const auto battery = identify_for_report(flights, {}, 12);
    EXPECT_FALSE(battery.identified);
    const auto section = battery_section(battery);
    EXPECT_TRUE(section.figures.empty());
    for (const auto* reason :
         {"was not identified", "computed from throttle", "has no voltage", "is &lt;faulty&gt;", "no flight in it"}) {
        EXPECT_THAT(section.html, HasSubstr(reason));
    }
}

TEST(BatterySection, RefusesACapacityThatAFlightExceeds) {
    battery::IdentificationOptions options;
    options.capacity_ah = 0.01;
    EXPECT_THROW(identify_for_report(flights_on(test::known_pack(), 1), options, 12), UsageError);
}

}  // namespace
}  // namespace flightwatt::report
