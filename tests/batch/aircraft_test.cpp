#include "batch/aircraft.h"

#include "base/error.h"
#include "flight/flight_identity.h"
#include "helpers/sample_logs.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Flights = std::vector<FlightAircraft>;

/// "a, b; c": the flights of each group.
std::string groups_of(const Flights& flights) {
    std::string text;
    for (const auto& group : group_aircraft(flights)) {
        if (!text.empty()) text += "; ";
        for (const auto number : group.flights)
            text += (number == group.flights.front() ? "" : ", ") + flights[number].flight;
    }
    return text;
}

FlightAircraft without_id(const std::string& flight, const std::string& kind, std::optional<double> voltage_v,
                          std::optional<double> power_w) {
    return {flight, "", "PX4", kind, voltage_v, power_w};
}

TEST(AircraftGroups, DifferByIdNameAndBeingSynthetic) {
    EXPECT_EQ(groups_of({}), "");
    EXPECT_EQ(groups_of({{"a", "20", "Twinstar"}, {"b", "20", "Twinstar"}, {"c", "20", ""}, {"d", "", ""}}),
              "a, b, c, d");
    EXPECT_EQ(groups_of({{"a", "20", "Twinstar"}, {"b", "7", ""}, {"c", "20", "Twinstar"}}), "a, c; b");
    EXPECT_EQ(groups_of({{"a", "7", "Opterra"}, {"b", "7", "Twinstar"}}), "a; b");
    EXPECT_EQ(groups_of({{"a", "7", "Opterra_synthetic"}, {"b", "7", flight::unnamed_synthetic}}), "a, b");
    EXPECT_EQ(groups_of({{"a", "7", "Opterra"}, {"b", "7", flight::unnamed_synthetic}}), "a; b");
    EXPECT_EQ(groups_of({{"a", "", "PX4"}, {"b", "", "PX4 SITL"}}), "a; b");
}

TEST(AircraftGroups, DifferByKindWithoutAnId) {
    EXPECT_EQ(groups_of({{"copter", "0006", "PX4", "rotorcraft"}, {"wing", "", "PX4", "fixedwing"}}), "copter; wing");
    EXPECT_EQ(groups_of({{"copter", "0006", "PX4", "rotorcraft"}, {"unknown", "", "PX4", ""}}), "copter, unknown");
}

TEST(AircraftGroups, DifferByTheCellsOfTheirPacks) {
    EXPECT_EQ(groups_of({without_id("six", "", 24.0, {}), without_id("three", "", 12.4, {})}), "six; three");
    EXPECT_EQ(groups_of({{"six", "7", "", "", 24.0}, {"three", "7", "", "", 12.4}}), "six; three") << "of one id too";
    EXPECT_EQ(groups_of({without_id("three", "", 12.6, {}), without_id("four", "", 16.8, {})}), "three; four");
    EXPECT_EQ(groups_of({without_id("full", "", 25.2, {}), without_id("used", "", 22.2, {})}), "full, used");
}

TEST(AircraftGroups, HaveCellsThatOnePackCanHave) {
    EXPECT_EQ(possible_cells(12.6), (CellRange{3, 3}));
    EXPECT_EQ(possible_cells(13.05), (CellRange{3, 3})) << "three full high-voltage cells";
    EXPECT_EQ(possible_cells(16.8), (CellRange{4, 5}));
    EXPECT_EQ(possible_cells(25.2), (CellRange{6, 7}));
    EXPECT_EQ(possible_cells(3.0), (CellRange{1, 1})) << "one, nearly empty";
    EXPECT_EQ(possible_cells(0.0), CellRange{});
    for (int cells = 1; cells <= 14; ++cells) {
        for (const double cell_v : {3.3, 3.7, 4.2, 4.35}) {
            const auto [min, max] = possible_cells(cells * cell_v);
            EXPECT_LE(min, cells) << cell_v;
            EXPECT_GE(max, cells) << cell_v;
        }
    }
}

TEST(AircraftGroups, DifferByPowerBeyondPayloadAndWind) {
    EXPECT_EQ(groups_of({without_id("light", "", {}, 100.0), without_id("loaded", "", {}, 283.0)}), "light, loaded");
    EXPECT_EQ(groups_of({without_id("small", "", {}, 100.0), without_id("large", "", {}, 301.0)}), "small; large");
    EXPECT_EQ(groups_of({{"glides", "7", "", "", {}, 10.0}, {"climbs", "7", "", "", {}, 90.0}}), "glides, climbs")
        << "both logs state the id";
    EXPECT_EQ(
        groups_of({{"glides", "7", "", "", {}, 10.0}, {"climbs", "7", "", "", {}, 90.0}, {"x", "", "", "", {}, 40.0}}),
        "glides, climbs, x");
}

TEST(AircraftGroups, DoNotDependOnTheOrderOfTheLogs) {
    Flights flights{{"a", "20", "Twinstar", "fixedwing", 12.4, 40.0},
                    {"b", "", "", "rotorcraft", 24.0, 400.0},
                    {"c", "", "", "", 11.9, 45.0},
                    {"d", "", "", "", {}, {}},
                    {"e", "31", "Quad", "rotorcraft", 16.0, 150.0},
                    {"f", "", "", "rotorcraft", {}, 900.0}};
    const auto sets = [&] {
        std::vector<std::string> texts;
        for (const auto& group : group_aircraft(flights)) {
            std::vector<std::string> names;
            for (const auto number : group.flights) names.push_back(flights[number].flight);
            std::ranges::sort(names);
            texts.push_back(fmt::format("{}{}", fmt::join(names, ","), group.may_be.empty() ? "" : "?"));
        }
        std::ranges::sort(texts);
        return texts;
    };
    const auto expected = sets();
    EXPECT_THAT(expected, ElementsAre("a,c", "b,f", "d?", "e"));
    std::ranges::sort(flights, {}, &FlightAircraft::flight);
    while (std::ranges::next_permutation(flights, {}, &FlightAircraft::flight).found) ASSERT_EQ(sets(), expected);
}

/// Neither joins an aircraft because the other one joined another.
TEST(AircraftGroups, AreNotCertainByFlightsThatAreNot) {
    const Flights flights{
        {"a", "2A002500-1747"}, {"b", "3B004400-1747"}, {"three", "", "", "", 12.0}, {"six", "", "", "", 24.0}};
    const auto groups = group_aircraft(flights);
    ASSERT_EQ(groups.size(), 4U);
    for (const std::size_t uncertain : {2U, 3U})
        EXPECT_THAT(groups[uncertain].may_be, ElementsAre("2A002500", "3B004400"));
}

TEST(AircraftGroups, NameTheAircraftOfWhichAFlightMayBe) {
    const Flights flights{{"a", "2A002500-1747", "ArduCopter"}, {"b", "3B004400-1747", "ArduCopter"}, {"c"}, {"d"}};
    const auto groups = group_aircraft(flights);
    ASSERT_EQ(groups.size(), 3U);
    EXPECT_THAT(groups[0].may_be, IsEmpty());
    EXPECT_THAT(groups[2].may_be, ElementsAre("2A002500", "3B004400"));
    EXPECT_EQ(groups[2].selector, "c");
    EXPECT_THAT(aircraft_table(groups, flights, 80),
                HasSubstr("\nc, d: of no certain aircraft, as nothing contradicts 2A002500 or 3B004400\n"));
}

/// What find_aircraft finds: the first flight, or the error.
std::string found(const std::string& text, const Flights& flights) {
    try {
        return flights[find_aircraft(text, group_aircraft(flights), flights).flights.front()].flight;
    } catch (const UsageError& error) {
        return error.what();
    }
}

TEST(FindAircraft, TakesAnIdItsBeginningANameAndAFlight) {
    const Flights flights{{"y6_2004", "2A002500-17473235", "ArduCopter"},
                          {"y6_2044", "2A002500-17473235", "ArduCopter"},
                          {"quad", "2A003300-17473235", "ArduCopter"},
                          {"plane", "2C001100-17473235", "ArduPlane"},
                          {"wing", "", "PX4", "fixedwing"},
                          {"7", "70", "Seven"}};
    EXPECT_EQ(found("2A003300-17473235", flights), "quad");
    EXPECT_EQ(found("2A0033", flights), "quad");
    EXPECT_EQ(found("y6_2044", flights), "y6_2004");
    EXPECT_EQ(found("ArduPlane", flights), "plane");
    EXPECT_EQ(found("PX4", flights), "wing");
    EXPECT_EQ(found("7", flights), "7") << "a flight's name is nearer than the beginning of an id";
    EXPECT_THAT(found("2A00", flights), HasSubstr("--aircraft 2A00: it names several aircraft; there are: 2A002500 "
                                                  "ArduCopter: y6_2004, y6_2044; 2A003300 ArduCopter: quad; "));
    EXPECT_THAT(found("ArduCopter", flights), HasSubstr("it names several aircraft"));
    EXPECT_THAT(found("2A0", flights), HasSubstr("no such aircraft")) << "too short a beginning";
    EXPECT_THAT(found("", flights), HasSubstr("no such aircraft"));
    EXPECT_THAT(found("8", flights), HasSubstr("--aircraft 8: there is no such aircraft; there are: 2A002500"));
}

TEST(FindAircraft, FindsWhatTheTableOffers) {
    const Flights flights{
        {"a", "000600000000-1", "PX4"}, {"b", "000600000000-2", "PX4"},      {"c", "7", "Opterra"},
        {"d", "7", "Twinstar"},         {"e", "", "PX4", "fixedwing", 12.0}, {"f", "", "PX4", "", 24.0},
        {"g", "", "Quad", "", 24.0}};
    const auto groups = group_aircraft(flights);
    for (const auto& group : groups) {
        SCOPED_TRACE(group.selector);
        EXPECT_EQ(find_aircraft(group.selector, groups, flights).flights, group.flights);
    }
    EXPECT_EQ(groups[0].selector, "000600000000-1") << "no shorter beginning is of one aircraft";
}

TEST(AircraftTable, FitsInto80Columns) {
    Flights flights;
    for (int i = 0; i < 30; ++i)
        flights.push_back({fmt::format("20_07_05__10_26_{:02}", i), "2A002500-17473235-32303436",
                           "a long name of the laboratory", "rotorcraft", 24.0, 400.0 + i});
    flights.push_back({"09_05_13__14_38_13", "", "", "fixedwing", 12.3, 30.0});
    const auto table = aircraft_table(group_aircraft(flights), flights, 80);
    EXPECT_THAT(table, HasSubstr("2A002500            a long name...  rotorcraft  6 to 7  400 to 429  30: 20_07..."));
    EXPECT_THAT(table, HasSubstr("09_05_13__14_38_13  -               fixedwing        3          30  1: 09_05_..."));
    for (std::size_t begin = 0, end = 0; (end = table.find('\n', begin)) != std::string::npos; begin = end + 1)
        EXPECT_LE(end - begin, 80U);
}

TEST(AircraftOf, ALogIsWhatItShows) {
    const auto loaded = flight::load_flight(test::sample(1));
    const auto aircraft = aircraft_of(loaded);
    EXPECT_EQ(aircraft.flight, "opterra_synthetic_01");
    EXPECT_EQ(aircraft.id, "7");
    EXPECT_EQ(aircraft.kind, loaded.series.firmware);
    EXPECT_EQ(possible_cells(aircraft.pack_voltage_v.value()), (CellRange{3, 3}));
    EXPECT_NEAR(aircraft.cruise_power_w.value(), 27.3, 0.1);
    auto without_power = loaded;
    without_power.lacks_power = "no measured power";
    EXPECT_FALSE(aircraft_of(without_power).cruise_power_w);
}

}  // namespace
}  // namespace flightwatt::batch
