#include "path/trajectory/shortest_way.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using std::numbers::pi;
constexpr double radius_m = 20.0;

FlightPath path_of(const Pose& from, const Pose& to) {
    FlightPath path;
    for (const auto& shape : shortest_way(from, to, radius_m)) path.elements.emplace_back().shape = shape;
    return path;
}

double length_of(const FlightPath& path) {
    double sum_m = 0.0;
    for (const auto& element : path.elements) {
        if (const auto* leg = std::get_if<Leg>(&element.shape)) sum_m += leg->length_m;
        if (const auto* arc = std::get_if<Circles>(&element.shape)) sum_m += 2.0 * pi * arc->turns * arc->radius_m;
    }
    return sum_m;
}

TEST(ShortestWay, EndsWhereItShallFromAnyPose) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-90.0, 90.0);
    std::uniform_real_distribution<double> course(0.0, 360.0);
    for (int i = 0; i < 2000; ++i) {
        const Pose from{{place(random), place(random)}, course(random)};
        const Pose to{{place(random), place(random)}, course(random)};
        const auto path = path_of(from, to);
        const auto end = local_position_at(path, {path.elements.size(), 0.0});
        EXPECT_NEAR(from.place.east_m + end.east_m, to.place.east_m, 1e-5);
        EXPECT_NEAR(from.place.north_m + end.north_m, to.place.north_m, 1e-5);
        double course_deg = from.course_deg;
        for (const auto& element : path.elements) {
            const auto* arc = std::get_if<Circles>(&element.shape);
            const double start_deg = arc != nullptr ? arc->start_course_deg : std::get<Leg>(element.shape).course_deg;
            EXPECT_NEAR(std::remainder(start_deg - course_deg, 360.0), 0.0, 1e-6);
            if (arc != nullptr) course_deg += (arc->to_right ? 360.0 : -360.0) * arc->turns;
        }
        EXPECT_NEAR(std::remainder(to.course_deg - course_deg, 360.0), 0.0, 1e-6);
        EXPECT_GE(length_of(path), std::hypot(end.east_m, end.north_m) - 1e-6);
    }
}

TEST(ShortestWay, HasTheLengthsOfKnownTurns) {
    const auto length = [](double east_m, double north_m, double course_deg) {
        return length_of(path_of({{}, 0.0}, {{east_m, north_m}, course_deg}));
    };
    EXPECT_NEAR(length(0.0, 500.0, 0.0), 500.0, 1e-9);
    EXPECT_NEAR(length(2.0 * radius_m, 0.0, 180.0), pi * radius_m, 1e-6);
    EXPECT_NEAR(length(-100.0, 0.0, 180.0), pi * radius_m + 60.0, 1e-6);
    EXPECT_NEAR(length(radius_m, radius_m, 90.0), pi / 2.0 * radius_m, 1e-6);
    for (const double spacing_m : {5.0, 15.0, 30.0}) {  // a bulb: out, around and in, each tangent to the next
        const double out = std::acos((spacing_m + 2.0 * radius_m) / (4.0 * radius_m));
        EXPECT_NEAR(length(spacing_m, 0.0, 180.0), radius_m * (pi + 4.0 * out), 1e-6) << spacing_m;
        EXPECT_NEAR(length(-spacing_m, 0.0, 180.0), radius_m * (pi + 4.0 * out), 1e-6) << spacing_m;
    }
}

TEST(ShortestWay, IsNoneBetweenEqualPoses) {
    EXPECT_TRUE(shortest_way({{3.0, 4.0}, 50.0}, {{3.0, 4.0}, 50.0}, 9.0).empty());
}

}  // namespace
}  // namespace flightwatt::path
