// How many segments a curve gets: as few as predict what is left out.

#include "battery/identification/aligned_fit.h"
#include "helpers/battery_coverage.h"

#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

int segments_of(test::PackCurve curve, std::size_t flights, double resistance_spread) {
    const auto drawn = test::drawn_flights({curve, flights, true, false, resistance_spread, 0.0}, 31);
    return choose_segment_count(fit_circuit_jointly(drawn.records, 3));
}

TEST(SegmentChoice, TakesAStraightCurveForStraight) {
    EXPECT_EQ(segments_of(test::PackCurve::straight, 3, 0.0), 1);
    EXPECT_LE(segments_of(test::PackCurve::straight, 3, 0.15), 2);
}

TEST(SegmentChoice, SeesThatACurveIsBent) { EXPECT_GE(segments_of(test::PackCurve::polymer, 3, 0.0), 3); }

}  // namespace
}  // namespace flightwatt::battery
