// How many segments a curve gets: as few as predict what is left out.

#include "battery/identification/aligned_fit.h"
#include "helpers/battery_coverage.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

std::vector<int> segments_of(test::PackCurve curve, std::size_t flights, double resistance_spread) {
    const auto drawn = test::drawn_flights({curve, flights, true, false, resistance_spread, 0.0}, 31);
    const auto aligned = fit_circuit_jointly(drawn.records, 3);
    return rank_segment_counts(aligned.records, aligned.fit);
}

TEST(SegmentChoice, TakesAStraightCurveForStraight) {
    EXPECT_EQ(segments_of(test::PackCurve::straight, 3, 0.0).front(), 1);
    EXPECT_LE(segments_of(test::PackCurve::straight, 3, 0.15).front(), 2);
}

TEST(SegmentChoice, SeesThatACurveIsBent) { EXPECT_GE(segments_of(test::PackCurve::polymer, 3, 0.0).front(), 3); }

TEST(SegmentChoice, TriesEachNumberOnce) {
    auto all = segments_of(test::PackCurve::known, 1, 0.0);
    std::ranges::sort(all);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<int>(i) + 1);
    EXPECT_EQ(all.size(), 12U);
}

}  // namespace
}  // namespace flightwatt::battery
