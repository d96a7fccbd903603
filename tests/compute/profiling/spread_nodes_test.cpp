#include "compute/profiling/spread_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using Points = std::vector<std::vector<double>>;

Points grid(const std::vector<double>& xs, const std::vector<double>& ys) {
    Points points;
    for (const double x : xs) {
        for (const double y : ys) points.push_back({x, y});
    }
    return points;
}

TEST(SpreadNodes, TakesCornersFirstThenTheFarthest) {
    const auto points = grid({1, 2, 4, 8, 16}, {0, 1, 2, 3, 4});
    const auto four = spread_nodes(points, 4);
    EXPECT_THAT(four, testing::UnorderedElementsAre(0U, 4U, 20U, 24U));
    EXPECT_EQ(four[1], 24U);                         // opposite to the first
    EXPECT_EQ(spread_nodes(points, 5).back(), 12U);  // the middle, by rank
    EXPECT_EQ(spread_nodes(points, 99).size(), 25U);
    EXPECT_THAT(spread_nodes({{7.0}}, 3), testing::ElementsAre(0U));
    EXPECT_THAT(spread_nodes({{}}, 3), testing::ElementsAre(0U));
}

TEST(UnitPoints, ScaleByValueOrByRank) {
    const Points points{{1.0, 3.0}, {2.0, 3.0}, {5.0, 3.0}};
    EXPECT_EQ(unit_points(points, AxisScale::value), (Points{{0.0, 0.0}, {0.25, 0.0}, {1.0, 0.0}}));
    EXPECT_EQ(unit_points(points, AxisScale::rank), (Points{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}}));
}

}  // namespace
}  // namespace flightwatt::compute
