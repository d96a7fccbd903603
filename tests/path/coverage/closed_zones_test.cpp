#include "path/coverage/closed_zones.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

const Polygon square{{100, -50}, {200, -50}, {200, 50}, {100, 50}};

TEST(ClosedZones, AreWidened) {
    const ClosedZones zones({square}, 10.0);
    const auto parts = zones.parts_of_line(90.0, 0.0);
    EXPECT_NEAR(std::ranges::min(parts, {}, &LinePart::from_m).from_m, 90.0, 1e-6);
    EXPECT_NEAR(std::ranges::max(parts, {}, &LinePart::to_m).to_m, 210.0, 1e-6);
    EXPECT_FALSE(zones.parts_of_line(90.0, -59.0).empty());
    EXPECT_TRUE(zones.parts_of_line(90.0, -61.0).empty());
}

TEST(ClosedZones, AreCrossedByWaysThroughThemOnly) {
    const ClosedZones zones({square}, 0.0);
    EXPECT_TRUE(zones.are_crossed({0, 0}, {300, 0}));
    EXPECT_TRUE(zones.are_crossed({0, 0}, {101, 0}));
    EXPECT_FALSE(zones.are_crossed({0, 0}, {99, 0}));
    EXPECT_FALSE(zones.are_crossed({0, 60}, {300, 60}));
    EXPECT_FALSE(zones.are_crossed({0, 0}, {0, 0}));
}

TEST(ClosedZones, HaveTheShortestWayAround) {
    const ClosedZones zones({square}, 10.0);
    EXPECT_TRUE(zones.way_around({0, 100}, {300, 100})->empty());
    auto way = zones.way_around({0, 20}, {300, 20});
    // Two tangents of 103.9 m, two arcs of 3.9 m and 100 m along the zone.
    double length_m = 0.0;
    LocalPosition at{0, 20};
    way->push_back({300, 20});
    for (const auto& corner : *way) {
        EXPECT_FALSE(zones.are_crossed(at, corner));
        length_m += distance_between_m(at, corner);
        at = corner;
    }
    EXPECT_NEAR(length_m, 315.6, 1.0);
}

TEST(ClosedZones, HaveAStraightWayAlongTheDistanceAtWhichLinesEnd) {
    for (int course_deg = 0; course_deg < 180; ++course_deg) {
        const LocalPosition corner{123.4, 56.7};
        const auto next = moved(corner, 100.0, course_deg);
        const auto right_deg = course_deg + 90.0;
        const ClosedZones zones({{corner, next, moved(next, 80.0, right_deg), moved(corner, 80.0, right_deg)}}, 10.0);
        const auto from = moved(moved(corner, 20.0, course_deg), -10.0, right_deg);
        const auto to = moved(moved(corner, 70.0, course_deg), -10.0, right_deg);
        EXPECT_TRUE(zones.way_around(from, to)->empty()) << course_deg;
        EXPECT_FALSE(zones.way_around(from, moved(to, 1.0, right_deg)).has_value()) << "a place nearer than that";
    }
}

TEST(ClosedZones, HaveNoWayToAPlaceInThem) { EXPECT_FALSE(ClosedZones({square}, 10.0).way_around({0, 0}, {150, 0})); }

}  // namespace
}  // namespace flightwatt::path
