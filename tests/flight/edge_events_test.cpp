#include "flight/edge_events.h"

#include "flight/load_flight.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

Sortie sortie_at(double lift_off_s, double takeoff_end_s, double landing_start_s, double touchdown_s) {
    Sortie sortie;
    sortie.height_m = 100.0;
    const auto edge = [](double time_s) {
        PhaseEdge result;
        result.time_s = time_s;
        return result;
    };
    sortie.phases = {{Phase::takeoff, edge(lift_off_s), edge(takeoff_end_s), true},
                     {Phase::cruise, edge(takeoff_end_s), edge(landing_start_s), true},
                     {Phase::landing, edge(landing_start_s), edge(touchdown_s), true}};
    return sortie;
}

Track takeoff_at(std::vector<double> time_s) {
    const std::vector<double> ones(time_s.size(), 1.0);
    return {.name = "takeoff", .time_s = std::move(time_s), .value = ones};
}

std::vector<std::string> verdicts(const FlightSeries& series, const Sortie& sortie) {
    std::vector<std::string> texts;
    for (const auto& edge : compare_edges_with_events(SelectedTracks(series), sortie)) texts.push_back(edge.agreement);
    return texts;
}

TEST(EdgeEvents, GivesAVerdictOnEveryEdge) {
    FlightSeries series;
    series.tracks = {takeoff_at({20.0, 98.0}),  // a false one, and the true one
                     {.name = "block", .time_s = {0, 120, 700}, .value = {3, 4, 6}},
                     {.name = "mode", .time_s = {0, 110, 703}, .value = {0, 2, 1}}};
    series.block_names = {{3, "Take-off"}, {4, "Standby"}, {6, "Land Right"}};
    const auto sortie = sortie_at(100, 130, 702, 760);
    EXPECT_THAT(verdicts(series, sortie), testing::ElementsAre("agrees", "no event", "agrees", "no event"));
    const auto edges = compare_edges_with_events(SelectedTracks(series), sortie);
    EXPECT_EQ(edges[0].matching_events.size(), 1u);
    EXPECT_EQ(edges[0].matching_events[0].after_s, -2.0);
    EXPECT_EQ(edges[1].other_events[0].what, "block Take-off -> Standby");
    EXPECT_EQ(edges[1].other_events[1].what, "mode 0 -> 2");
    EXPECT_TRUE(edges[1].matching_events.empty());
    EXPECT_EQ(edges[2].matching_events[0].what, "block Standby -> Land Right");
    EXPECT_TRUE(edges[2].other_events.empty());
}

TEST(EdgeEvents, SaysHowFarApartTheyAre) {
    FlightSeries series;
    series.tracks = {takeoff_at({80.0}), {.name = "mode", .time_s = {0, 110, 720}, .value = {0, 2, 1}}};
    EXPECT_THAT(verdicts(series, sortie_at(100, 130, 702, 760)),
                testing::ElementsAre("differs by 20 s", "no event", "differs by 18 s", "no event"));
}

TEST(EdgeEvents, HasNoneInASeriesWithoutMessagesAndNoEdgeThatTheLogCuts) {
    auto sortie = sortie_at(100, 130, 702, 760);
    EXPECT_THAT(verdicts({}, sortie), testing::Each("no event"));
    sortie.phases.erase(sortie.phases.begin());
    sortie.phases.back().complete = false;
    const auto edges = compare_edges_with_events(SelectedTracks(FlightSeries{}), sortie);
    ASSERT_EQ(edges.size(), 1u);
    EXPECT_EQ(edges[0].kind, EdgeKind::landing_start);
}

TEST(EdgeEvents, AgreesWithTakeoffMessagesOfTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        SCOPED_TRACE(name);
        const auto series = read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        const auto edges = compare_edges_with_events(SelectedTracks(series), segment(series).sorties.at(0));
        ASSERT_EQ(edges.size(), 4u);
        ASSERT_EQ(edges[0].matching_events.size(), 1u);
        EXPECT_LT(std::abs(edges[0].matching_events[0].after_s), 3.0);
        EXPECT_EQ(edges[2].agreement, "agrees") << "the pilot took over to land";
    }
}

}  // namespace
}  // namespace flightwatt::flight
