#include "report/document/flights_document.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

ReportFlight sample_flight(const std::filesystem::path& file) {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(file));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    flight.facts = summarize_flight(flight);
    return flight;
}

TEST(FlightsDocument, NamesEveryReasonOnceWithItsFlights) {
    auto whole = sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    auto one = sample_flight(test::hazards_dir() / "hazard_01_run-up.data");
    auto two = sample_flight(test::hazards_dir() / "hazard_01_two-sorties.data");
    for (auto* flight : {&one, &two}) {
        flight->unusable_power = "made for <segmentation>";
        flight->exclusions = {flight->name + ": it is excluded: made for <segmentation>"};
    }
    BatchContent batch;
    batch.flights = {whole, one, two};
    LatexTables tables;
    const auto document = make_flights(batch, nullptr, false, tables);
    ASSERT_EQ(document.exclusions.size(), 1U);
    EXPECT_EQ(document.exclusions[0]["flights"], (Json{"hazard_01_run-up", "hazard_01_two-sorties"}));
    EXPECT_EQ(document.exclusions[0]["reason"], "it is excluded: made for <segmentation>");
    EXPECT_EQ(document.flights[0]["used"], "all");
    EXPECT_EQ(document.flights[2]["used"], "no");
    EXPECT_EQ(document.flights[2]["sorties"].size(), 2U);
    EXPECT_THAT(tables.text, HasSubstr("hazard\\_01\\_two-sorties, sortie 2"));
}

TEST(FlightsDocument, CompressesTheDetailsOfManyFlights) {
    BatchContent batch;
    auto& flights = batch.flights;
    flights.assign(20, sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    LatexTables tables;
    const auto few = make_flights(batch, nullptr, false, tables).flights;
    EXPECT_TRUE(few[19]["detail"].is_object());
    auto rejected = flights.front();
    rejected.rejected = "it is made up";
    flights.insert(flights.begin(), rejected);
    const auto many = make_flights(batch, nullptr, false, tables).flights;
    EXPECT_TRUE(many[0]["detail"].is_null());
    EXPECT_EQ(many[0]["rejected"], "it is made up");
    ASSERT_TRUE(many[20]["detail"].is_string());
    EXPECT_LT(many[20]["detail"].get<std::string>().size(), few[19]["detail"].dump().size() / 4);
}

mechanical::MechanicalModel published_model() {
    return mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
}

TEST(FlightDetail, HasEveryTrackAndTheEvidenceOfItsEdges) {
    const auto flight = sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    const auto model = published_model();
    const auto detail = flight_detail(flight, &model, nullptr, 250);
    for (const auto* track : {"power", "altitude", "throttle", "voltage", "current"}) {
        ASSERT_TRUE(detail[track].is_object()) << track;
        EXPECT_GE(detail[track]["time_s"].size(), 200U) << track;
    }
    const auto& power = detail["power"];
    EXPECT_EQ(power["model_power_w"].size(), power["power_w"].size());
    EXPECT_TRUE(power["model_power_w"][0].is_null()) << "on the ground";
    EXPECT_EQ(detail["phases"].size(), 3U);
    const auto edges = detail["edges"].dump();
    for (const auto* edge : {"lift-off", "end of take-off", "end of cruise", "touchdown", "TAKEOFF message"})
        EXPECT_THAT(edges, HasSubstr(edge));
    EXPECT_EQ(detail["edges"].size(), 4U);
    EXPECT_TRUE(flight_detail(flight, nullptr, nullptr, 250)["power"]["model_power_w"].is_null());
}

TEST(FlightDetail, SaysWhereTheLogEnds) {
    auto flight = sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    auto& landing = flight.phases.sorties.front().phases.back();
    landing.complete = false;
    landing.end.time_s = flight.data.power_w.time_s.back();
    const auto edges = name_edges(flight);
    ASSERT_EQ(edges.size(), 4U);
    EXPECT_EQ(edges[3].name, "the log ends");
}

TEST(FlightDetail, HasNoTrackThatTheLogLacks) {
    auto flight = sample_flight(test::source_dir() / "logs/opterra_synthetic_01.data");
    flight.data.throttle_percent = {};
    EXPECT_TRUE(flight_detail(flight, nullptr, nullptr, 250)["throttle"].is_null());
}

}  // namespace
}  // namespace flightwatt::report
