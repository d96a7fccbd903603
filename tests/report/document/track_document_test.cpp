#include "report/document/track_document.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

ReportFlight sample_flight() {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    return flight;
}

TEST(FlightTrack, IsOfPhasesBrokenAtGapsWithMarksEvery5Minutes) {
    const auto track = track_json(sample_flight(), nullptr);
    EXPECT_EQ(track["lines"].size(), 12U) << "three phases and nine gaps";
    const auto& line = track["lines"].front();
    EXPECT_EQ(line["phase"], "takeoff");
    for (const auto* column : {"east_m", "north_m", "latitude_deg", "longitude_deg"})
        EXPECT_EQ(line[column].size(), line["time_s"].size()) << column;
    ASSERT_EQ(track["marks"].size(), 2U);
    EXPECT_EQ(track["marks"][1]["text"], "10 min") << "no battery is known";
    EXPECT_NEAR(track["marks"][1]["longitude_deg"].get<double>(), 10.39, 0.1);
}

TEST(FlightTrack, IsOfDegreesAloneOrMetresAlone) {
    auto flight = sample_flight();
    const auto both = track_json(flight, nullptr)["lines"].front();
    auto in_metres = flight;
    in_metres.data.longitude_deg = {};
    EXPECT_TRUE(track_json(in_metres, nullptr)["lines"].front()["latitude_deg"].is_null());
    flight.data.east_m = {};
    const auto in_degrees = track_json(flight, nullptr)["lines"].front();
    const auto extent = [](const Json& line, const char* axis) {
        return line[axis].back().get<double>() - line[axis].front().get<double>();
    };
    for (const auto* axis : {"east_m", "north_m"})
        EXPECT_NEAR(extent(in_degrees, axis), extent(both, axis), 10.0) << axis;
    flight.data.latitude_deg = {};
    EXPECT_TRUE(track_json(flight, nullptr).is_null());
}

TEST(FlightTrack, HasTheChargeOfAnIdentifiedBattery) {
    const std::vector flights{sample_flight()};
    const auto battery = identify_for_report(flights, {}, 1);
    if (!battery.identified) GTEST_SKIP() << battery.no_result_reason;
    EXPECT_THAT(track_json(flights.front(), &battery)["marks"][1]["text"].get<std::string>(),
                testing::MatchesRegex("10 min: [0-9]+ %"));
}

}  // namespace
}  // namespace flightwatt::report
