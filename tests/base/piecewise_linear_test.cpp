#include "base/piecewise_linear.h"

#include <vector>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

const std::vector<double> knots{0.0, 1.0, 3.0};
const std::vector<double> values{10.0, 20.0, 0.0};

TEST(PiecewiseLinear, StraightBetweenKnotsAndExactAtThem) {
    for (std::size_t i = 0; i < knots.size(); ++i) {
        EXPECT_EQ(interpolate_clamped(knots, values, knots[i]), values[i]);
        EXPECT_EQ(interpolate_extended(knots, values, knots[i]), values[i]);
    }
    EXPECT_DOUBLE_EQ(interpolate_clamped(knots, values, 0.5), 15.0);
    EXPECT_DOUBLE_EQ(interpolate_extended(knots, values, 2.0), 10.0);
}

TEST(PiecewiseLinear, BeyondTheEndsHeldOrExtended) {
    EXPECT_EQ(interpolate_clamped(knots, values, -1.0), 10.0);
    EXPECT_EQ(interpolate_clamped(knots, values, 4.0), 0.0);
    EXPECT_DOUBLE_EQ(interpolate_extended(knots, values, -1.0), 0.0);
    EXPECT_DOUBLE_EQ(interpolate_extended(knots, values, 4.0), -10.0);
}

TEST(PiecewiseLinear, OneKnotIsAConstantWhereHeld) {
    const std::vector<double> one{2.0};
    EXPECT_EQ(interpolate_clamped(one, one, 1.0), 2.0);
    EXPECT_EQ(interpolate_clamped(one, one, 5.0), 2.0);
}

TEST(PiecewiseLinear, PlacesAmongKnots) {
    EXPECT_EQ(find_knot_interval(knots, 2.0).lower, 1U);
    EXPECT_DOUBLE_EQ(find_knot_interval(knots, 2.0).fraction, 0.5);
    EXPECT_EQ(find_knot_interval(knots, 4.0).lower, 1U);
    EXPECT_DOUBLE_EQ(find_knot_interval(knots, 4.0).fraction, 1.5);
    EXPECT_DOUBLE_EQ(find_knot_interval(knots, -1.0).fraction, -1.0);
}

}  // namespace
}  // namespace flightwatt
