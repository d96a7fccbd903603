#include "mission/planning/schedule_value.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

std::vector<CurvePoint> random_points(std::mt19937& random, int count) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<CurvePoint> points;
    for (int i = 0; i < count; ++i) points.push_back({uniform(random), uniform(random)});
    return points;
}

TEST(ConcaveCurve, StandsOverItsPointsAndIsTheLeast) {
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        const auto points = random_points(random, 1 + round);
        const auto hull = concave_hull(points);
        for (const auto& point : points) EXPECT_GE(value_at(hull, point.x), point.y - 1e-12);
        double last_slope = INFINITY;
        for (std::size_t i = 0; i < hull.points.size(); ++i) {
            const bool is_given = std::ranges::any_of(
                points, [&](const auto& p) { return p.x == hull.points[i].x && p.y == hull.points[i].y; });
            EXPECT_TRUE(is_given) << "corners are points: nothing concave lies lower";
            if (i == 0) continue;
            const auto& a = hull.points[i - 1];
            const auto& b = hull.points[i];
            const double slope = (b.y - a.y) / (b.x - a.x);
            EXPECT_GT(slope, 0.0);
            EXPECT_LT(slope, last_slope);
            last_slope = slope;
        }
    }
}

TEST(ConcaveCurve, EndsLevelAndBeginsAtNothing) {
    const auto hull = concave_hull({{0.0, 1.0}, {1.0, 3.0}, {2.0, 2.0}});
    EXPECT_EQ(value_at(hull, -1e-9), -INFINITY);
    EXPECT_EQ(value_at(hull, 0.0), 1.0);
    EXPECT_EQ(value_at(hull, 0.5), 2.0);
    EXPECT_EQ(value_at(hull, 1.0), 3.0);
    EXPECT_EQ(value_at(hull, 5.0), 3.0);
    EXPECT_EQ(value_at(concave_hull({}), 0.0), -INFINITY);
}

TEST(ConcaveCurve, BoundsWhateverAMapMayBe) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int round = 0; round < 50; ++round) {
        const auto curve = concave_hull(random_points(random, 8));
        const double growth = 1.0 + uniform(random);
        // A map that rises by the growth and something more, in cells of 0.1.
        const double more = uniform(random);
        const auto map = [&](double x) { return -0.3 + growth * x + more * x * x; };
        std::vector<CurvePoint> points;
        for (int cell = 0; cell < 10; ++cell) {
            const double end = 0.1 * (cell + 1);
            add_mapped(curve, {end - 0.1, end, map(end), growth}, 2.0, points);
        }
        const auto bound = concave_hull(std::move(points));
        for (double x = 0.0; x <= 1.0; x += 0.003)
            ASSERT_GE(value_at(bound, x) + 1e-12, 2.0 + value_at(curve, map(x))) << x;
    }
}

}  // namespace
}  // namespace flightwatt::mission
