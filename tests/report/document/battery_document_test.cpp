#include "report/document/battery_document.h"

#include "base/error.h"
#include "flight/select.h"
#include "helpers/synthetic_discharge.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

ReportFlight flight_on(const battery::Battery& pack, std::uint64_t seed) {
    ReportFlight flight;
    flight.data = select_tracks(test::synthetic_discharge(pack, {}, seed));
    flight.name = flight.data.flight;
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

Json json_of(const ReportBattery& battery) {
    LatexTables tables;
    return battery_json(battery, tables);
}

TEST(BatteryDocument, ShowsVoltagesParametersAndTheCurve) {
    const auto pack = test::known_pack();
    const auto battery = identify_for_report(flights_on(pack, 2), with_capacity(pack), 12);
    ASSERT_TRUE(battery.identified) << battery.no_result_reason;
    EXPECT_EQ(battery.leave_one_out.size(), 2U);
    LatexTables tables;
    const auto json = battery_json(battery, tables);
    ASSERT_EQ(json["voltages"].size(), 2U);
    const auto& voltages = json["voltages"][0];
    EXPECT_GT(voltages["time_s"].size(), 100U);
    for (const auto* curve : {"measured_v", "model_v"}) EXPECT_EQ(voltages[curve].size(), voltages["time_s"].size());
    EXPECT_EQ(json["open_circuit"]["low_v"].size(),
              battery.identified->battery.thevenin->open_circuit.soc_percent.size());
    EXPECT_EQ(json["identified"]["flights"].size(), 2U) << "as flightwatt battery prints it";
    EXPECT_THAT(json["parameters"]["rows"].dump(), HasSubstr("resistance [ohm]"));
    EXPECT_THAT(json["text"].get<std::string>(), HasSubstr("identified from voltage, current and charge of 2 flights"));
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:battery-flights}"));
    EXPECT_THAT(tables.text, testing::Not(HasSubstr("\\label{tab:battery-excluded}"))) << "all are used";
}

TEST(BatteryDocument, LimitsTheFlightsAndSaysSo) {
    const auto pack = test::known_pack();
    const auto battery = identify_for_report(flights_on(pack, 5), with_capacity(pack), 2);
    EXPECT_EQ(battery.usable, 5U);
    ASSERT_EQ(battery.records.size(), 2U);
    EXPECT_EQ(battery.records[0].flight, "synthetic_1");
    EXPECT_EQ(battery.records[1].flight, "synthetic_5");
    EXPECT_THAT(json_of(battery)["text"].get<std::string>(), HasSubstr("among the 5 usable ones"));
}

TEST(BatteryDocument, SaysWhyThereIsNone) {
    const auto pack = test::known_pack();
    auto computed = flight_on(pack, 1);
    computed.data.current_origin = flight::CurrentOrigin::throttle;
    auto voltless = flight_on(pack, 2);
    voltless.data.voltage_v = {};
    auto faulty = flight_on(pack, 3);
    faulty.unusable_power = "its power record is <faulty>";
    ReportFlight rejected;
    rejected.name = "rejected";
    rejected.rejected = "no flight in it";
    const std::vector<ReportFlight> flights{computed, voltless, faulty, rejected};
    const auto battery = identify_for_report(flights, {}, 12);
    EXPECT_FALSE(battery.identified);
    LatexTables tables;
    const auto json = battery_json(battery, tables);
    EXPECT_TRUE(json["identified"].is_null());
    EXPECT_EQ(json["no_result_reason"], "no flight has both voltage and current");
    for (const auto* reason : {"computed from throttle", "has no voltage", "no flight in it"})
        EXPECT_THAT(tables.text, HasSubstr(reason));
}

/// A mission on the pack that was identified from flights, with the capacity that was given for it.
mission::MissionVariant mission_on(const std::vector<ReportFlight>& flights, double given_ah) {
    mission::Mission mission;
    battery::IdentificationOptions options;
    options.capacity_ah = given_ah;
    options.name = "pack";
    mission.setup.battery = identify_for_report(flights, options, 12).identified.value().battery;
    return mission;
}

TEST(BatteryDocument, IsAboutThePackOfTheMissions) {
    const auto flights = flights_on(test::known_pack(), 2);
    const std::vector missions{mission_on(flights, 10.0), mission_on(flights, 10.0)};
    const auto battery = identify_for_report(flights, {}, 12, missions);
    ASSERT_TRUE(battery.identified);
    EXPECT_EQ(battery.identified->battery.capacity_ah, 10.0);
    const auto text = json_of(battery).dump();
    EXPECT_THAT(text, HasSubstr("The capacity is that of the missions' pack 'pack'."));
    EXPECT_THAT(text, HasSubstr("the capacity of 10 Ah contradicts the flights"));
    EXPECT_THAT(text, testing::Not(HasSubstr("with --capacity")));
    battery::IdentificationOptions other;
    other.capacity_ah = 5.0;
    EXPECT_THROW(identify_for_report(flights, other, 12, missions), UsageError) << "a page has one pack";
    other.capacity_ah = 10.0;
    EXPECT_TRUE(identify_for_report(flights, other, 12, missions).identified);
}

TEST(BatteryDocument, StatesTheOneCapacityThatTheMissionsPackHasByItsFlights) {
    const auto flights = flights_on(test::known_pack(), 4);
    mission::Mission mission;
    const auto by_all = identify_for_report(flights, {}, 12);
    mission.setup.battery = by_all.identified.value().battery;
    const auto by_two = identify_for_report(flights, {}, 2);
    ASSERT_NE(by_two.identified.value().battery.capacity_ah, mission.setup.battery.capacity_ah);
    const auto battery = identify_for_report(flights, {}, 2, std::vector<mission::MissionVariant>{mission});
    const auto& identified = battery.identified.value().battery;
    EXPECT_EQ(identified.capacity_ah, mission.setup.battery.capacity_ah);
    EXPECT_EQ(identified.flight_estimate, mission.setup.battery.flight_estimate);
}

TEST(BatteryDocument, IsNotAboutPacksOfOtherFlights) {
    const auto flights = flights_on(test::known_pack(), 2);
    const std::vector missions{mission_on({flight_on(test::known_pack(), 7)}, 10.0)};
    const auto battery = identify_for_report(flights, {}, 12, missions);
    EXPECT_NE(battery.identified.value().battery.capacity_ah, 10.0);
    EXPECT_TRUE(battery.notes.empty());
    auto stated = std::get<mission::Mission>(mission_on(flights, 10.0));
    stated.setup.capacity_is_stated = true;
    const auto by_flights = identify_for_report(flights, {}, 12, std::vector<mission::MissionVariant>{stated});
    EXPECT_NE(by_flights.identified.value().battery.capacity_ah, 10.0) << "that is the mission's alone";
}

TEST(BatteryDocument, TakesTheFirstOfSeveralPacks) {
    const auto flights = flights_on(test::known_pack(), 1);
    const std::vector missions{mission_on(flights, 2.4), mission_on(flights, 10.0)};
    const auto battery = identify_for_report(flights, {}, 12, missions);
    EXPECT_EQ(battery.identified.value().battery.capacity_ah, 2.4);
}

TEST(BatteryDocument, GoesOnWhereNewFlightsDrewMoreThanThePackHas) {
    const auto flights = flights_on(test::known_pack(), 1);
    auto mission = std::get<mission::Mission>(mission_on(flights, 2.4));
    mission.setup.battery.capacity_ah = 0.1;
    const auto battery = identify_for_report(flights, {}, 12, std::vector<mission::MissionVariant>{mission});
    EXPECT_TRUE(battery.identified);
    EXPECT_THAT(battery.notes, testing::ElementsAre(HasSubstr("is not used: --capacity is 0.1 Ah")));
}

TEST(BatteryDocument, RefusesACapacityThatAFlightExceeds) {
    battery::IdentificationOptions options;
    options.capacity_ah = 0.01;
    EXPECT_THROW(identify_for_report(flights_on(test::known_pack(), 1), options, 12), UsageError);
}

}  // namespace
}  // namespace flightwatt::report
