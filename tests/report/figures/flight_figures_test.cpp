#include "report/figures/flight_figures.h"

#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

ReportFlight sample_flight() {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data"));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    return flight;
}

std::size_t lines_of(const VegaJson& layer) {
    const auto text = layer["data"]["values"].get<std::string>();
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(FlightFigure, HasEveryChannelAndExplainsItsEdges) {
    const auto flight = sample_flight();
    const auto model =
        mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    const auto figure = flight_figure(flight, &model, "flight-1-power");
    const auto& panels = figure.spec["vconcat"];
    ASSERT_EQ(panels.size(), 3U);
    for (const auto& panel : panels) EXPECT_GE(lines_of(panel["layer"].back()), 500U);
    const auto power = panels[2]["layer"].back()["data"]["values"].get<std::string>();
    EXPECT_NE(power.find(",measured"), std::string::npos);
    EXPECT_NE(power.find(",model"), std::string::npos);
    const auto edges = figure.spec["datasets"]["edges"].get<std::string>();
    for (const auto* edge : {"lift-off", "end of take-off", "end of cruise", "touchdown", "TAKEOFF message"}) {
        EXPECT_NE(edges.find(edge), std::string::npos) << edge;
    }
    EXPECT_EQ(std::count(edges.begin(), edges.end(), '\n'), 4);
}

TEST(FlightFigure, SaysWhereTheLogEnds) {
    auto flight = sample_flight();
    auto& landing = flight.phases.sorties.front().phases.back();
    landing.complete = false;
    landing.end.time_s = flight.data.power_w.time_s.back();
    const auto edges = name_edges(flight);
    ASSERT_EQ(edges.size(), 4U);
    EXPECT_EQ(edges[3].name, "the log ends");
}

TEST(FlightFigure, DrawsNoChannelThatTheLogLacks) {
    auto flight = sample_flight();
    flight.data.throttle_percent = {};
    EXPECT_EQ(flight_figure(flight, nullptr, "f").spec["vconcat"].size(), 2U);
}

}  // namespace
}  // namespace flightwatt::report
