#include "flight/segment/phase_edges.h"

#include "flight/segment.h"
#include "helpers/flown_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::Point;

/// A flight at 60 m from 130 s on; `end` is how it comes down.
Sortie flown(std::vector<Point> end, double left_s = 430.0) {
    std::vector<Point> points{{60, 0, 0}, {98, 0, 0}, {99, 0, 90}, {100, 0, 90}, {130, 60, 90}, {left_s, 60, 60}};
    points.insert(points.end(), end.begin(), end.end());
    const auto last_s = points.back().time_s;
    points.push_back({last_s + 1, 0, 0});
    points.push_back({last_s + 60, 0, 0});
    const auto phases = segment(select_tracks(test::series_of(points)));
    EXPECT_EQ(phases.sorties.size(), 1u);
    return phases.sorties.empty() ? Sortie{} : phases.sorties.front();
}

double landing_start_s(const Sortie& sortie) {
    return sortie.phases.empty() || sortie.phases.back().phase != Phase::landing ? -1.0
                                                                                 : sortie.phases.back().start.time_s;
}

TEST(PhaseEdges, LandingBeginsWhereTheCruiseIsLeftForGood) {
    // 40 s of circles at half the height, as a real flight of another aircraft landed.
    for (const double low_m : {25.0, 31.0, 35.0}) {
        const auto sortie = flown({{450, low_m, 30}, {490, low_m, 40}, {500, 0, 0}});
        EXPECT_NEAR(landing_start_s(sortie), 435.0, 4.0) << low_m;
    }
}

TEST(PhaseEdges, LandingTakesSeveralSteps) {
    const auto sortie = flown({{440, 44, 30}, {480, 44, 40}, {490, 32, 30}, {530, 32, 40}, {540, 0, 0}});
    EXPECT_NEAR(landing_start_s(sortie), 434.0, 3.0);
}

TEST(PhaseEdges, ASurveyInStagesIsACruise) {
    const auto sortie = flown({{440, 45, 40}, {590, 45, 60}, {600, 32, 40}, {750, 32, 60}, {765, 0, 0}}, 280.0);
    EXPECT_NEAR(landing_start_s(sortie), 751.0, 3.0);
    // Short stages too, if they are equal.
    const auto quick =
        flown({{170, 60, 60}, {180, 47, 40}, {220, 47, 60}, {230, 35, 40}, {270, 35, 60}, {285, 0, 0}}, 160.0);
    EXPECT_NEAR(landing_start_s(quick), 271.0, 3.0);
}

TEST(PhaseEdges, WorkFarBelowTheTransitIsACruise) {
    const auto sortie = flown({{445, 20, 40}, {625, 20, 60}, {640, 0, 0}});
    EXPECT_NEAR(landing_start_s(sortie), 626.0, 4.0);
}

TEST(PhaseEdges, AGliderThatKeepsItsHeightWithTheMotorOffDoesNotRest) {
    // In a thermal, and the log has no speed.
    const auto sortie =
        flown({{200, 60, 0}, {201, 60, 0}, {260, 61, 0}, {300, 60, 0}, {360, 30, 0}, {380, 0, 0}}, 199.0);
    ASSERT_EQ(sortie.phases.size(), 3u);
    EXPECT_NEAR(sortie.start_s(), 100.0, 3.0);
    EXPECT_NEAR(landing_start_s(sortie), 311.0, 4.0);
}

TEST(PhaseEdges, LiftOffAndTouchdownAreByTheGroundOnTheirSide) {
    for (const double after_m : {-40.0, 0.0, 40.0}) {
        const auto columns = test::columns_of({{0, 0, 0},
                                               {98, 0, 0},
                                               {99, 0, 90},
                                               {100, 0, 90},
                                               {160, 60, 90},
                                               {400, 60, 60},
                                               {430, after_m, 0},
                                               {500, after_m, 0}});
        const auto phases = segment(select_tracks(test::series_of(columns)));
        ASSERT_EQ(phases.sorties.size(), 1u) << after_m;
        EXPECT_NEAR(phases.sorties[0].start_s(), 101.5, 1.6) << after_m;
        EXPECT_NEAR(phases.sorties[0].end_s(), 429.0, 2.5) << after_m;
        EXPECT_EQ(phases.warnings.size(), after_m == 0.0 ? 0u : 1u);
    }
}

TEST(PhaseEdges, LiftOffIsNotBeforeTheMotorFirstRuns) {
    // An estimator that wanders on the ground for minutes, as far as a quarter of the height flown.
    auto columns = test::columns_of({{0, 0, 0},
                                     {40, 4, 0},
                                     {80, 18, 0},
                                     {120, 5, 0},
                                     {150, -2, 0},
                                     {200, 1, 0},
                                     {201, 1, 90},
                                     {230, 60, 90},
                                     {500, 60, 60},
                                     {530, 0, 0},
                                     {600, 0, 0}});
    const auto phases = segment(select_tracks(test::series_of(columns)));
    ASSERT_EQ(phases.sorties.size(), 1u);
    EXPECT_NEAR(phases.sorties[0].start_s(), 201.0, 3.0);
}

}  // namespace
}  // namespace flightwatt::flight
