#include "flight/vtol_flight.h"

#include "flight/phase_statistics.h"
#include "flight/segment.h"
#include "flight/select.h"
#include "helpers/flown_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

/// A sortie from 100 to 470 s that climbs to 100 m until 130 s and descends from 430 s on; hover takes 300 W, a
/// transition 200 W and the wing 80 W.
FlightData vtol(std::vector<double> time_s, const std::vector<VtolState>& states) {
    auto columns = test::columns_of(test::sortie(100.0), 0.1);
    Track state{.name = "vtol_state", .source = "x", .time_s = std::move(time_s)};
    for (const auto each : states) state.value.push_back(static_cast<double>(each));
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        const auto at = static_cast<VtolState>(state_at(state, columns.time_s[i]));
        columns.power_w[i] = at == VtolState::hover ? 300.0 : at == VtolState::wing ? 80.0 : 200.0;
    }
    auto series = test::series_of(columns);
    series.tracks.push_back(std::move(state));
    return select_tracks(series);
}

constexpr auto hover = VtolState::hover;
constexpr auto to_wing = VtolState::transition_to_wing;
constexpr auto to_hover = VtolState::transition_to_hover;
constexpr auto wing = VtolState::wing;

FlightData usual_vtol() { return vtol({0.0, 140.0, 150.0, 400.0, 410.0}, {hover, to_wing, wing, to_hover, hover}); }

TEST(VtolFlight, CruiseIsFlownOnTheWingAlone) {
    const auto data = usual_vtol();
    const auto phases = segment(data);
    ASSERT_EQ(phases.sorties.size(), 1U);
    const auto& spans = phases.sorties.front().phases;
    ASSERT_EQ(spans.size(), 3U);
    EXPECT_NEAR(spans[1].start.time_s, 150.0, 0.11) << "at 100 m from 130 s on, but in hover and transition";
    EXPECT_NEAR(spans[1].end.time_s, 400.0, 0.11) << "the descent begins at 430 s";
    EXPECT_NEAR(PowerStatistics(data).between(spans[1].start.time_s + 0.2, spans[1].end.time_s - 0.2).mean_power_w,
                80.0, 1e-6);
    EXPECT_TRUE(spans[0].complete && spans[1].complete && spans[2].complete);
    EXPECT_EQ(hover_in_cruise(data, phases.sorties.front()), "");
}

TEST(VtolFlight, PhasesByHeightStayWhereTheWingCarriesLonger) {
    const auto with = segment(vtol({0.0, 105.0, 460.0}, {hover, wing, hover}));
    auto data = usual_vtol();
    data.vtol_state = {};
    const auto without = segment(data);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(with.sorties.at(0).phases.at(i).start.time_s, without.sorties.at(0).phases.at(i).start.time_s);
}

TEST(VtolFlight, ThatNeverLeavesHoverIsSegmentedByHeight) {
    auto data = vtol({0.0}, {hover});
    const auto hovered = segment(data);
    data.vtol_state = {};
    const auto other = segment(data);
    EXPECT_EQ(hovered.sorties.at(0).phases.at(1).start.time_s, other.sorties.at(0).phases.at(1).start.time_s);
    EXPECT_THAT(hovered.warnings, testing::ElementsAre(HasSubstr("it never flies on its wing: its cruise is hover")));
    EXPECT_THAT(other.warnings, testing::IsEmpty());
}

TEST(VtolFlight, HoverWithinTheCruiseIsWarnedOf) {
    const auto data = vtol({0.0, 140.0, 250.0, 290.0, 410.0}, {hover, wing, hover, wing, hover});
    const auto phases = segment(data);
    EXPECT_THAT(phases.warnings, testing::Contains(HasSubstr("40 of 270 s of the cruise are hover or transitions")));
}

TEST(VtolFlight, EnergiesOfItsKindsAddUpToTheSortie) {
    const auto data = usual_vtol();
    const auto sortie = segment(data).sorties.front();
    const auto spans = vtol_spans(data, sortie.start_s(), sortie.end_s());
    ASSERT_EQ(spans.size(), 5U);
    EXPECT_EQ(to_string(spans[1].flight), "transition");
    EXPECT_EQ(to_string(spans[3].flight), "transition");
    const PowerStatistics power(data);
    double sum_wh = 0.0;
    for (const auto& span : spans) sum_wh += power.between(span.start_s, span.end_s).energy_wh;
    EXPECT_NEAR(sum_wh, power.between(sortie.start_s(), sortie.end_s()).energy_wh, 1e-9);
    EXPECT_THAT(describe_vtol(data, sortie), HasSubstr("transition 20 s, 1.1"));
    EXPECT_THAT(describe_vtol(data, sortie), HasSubstr("wing 250 s, 5.5"));
}

TEST(VtolFlight, OtherAircraftHaveNoSpansAndCountAsOnTheirWing) {
    FlightData data;
    EXPECT_THAT(vtol_spans(data, 0.0, 100.0), testing::IsEmpty());
    EXPECT_TRUE(is_on_wing(data, 0.0, 100.0));
    const auto of_vtol = usual_vtol();
    EXPECT_FALSE(is_on_wing(of_vtol, 120.0, 130.0));
    EXPECT_FALSE(is_on_wing(of_vtol, 145.0, 160.0));
    EXPECT_TRUE(is_on_wing(of_vtol, 150.0, 400.0));
}

}  // namespace
}  // namespace flightwatt::flight
