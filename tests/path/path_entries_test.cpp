#include "path/path_entries.h"

#include "helpers/rejected.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::rejected;

PathEntry entry(const std::string& name = "leg 1") {
    PathEntry made;
    made.name = name;
    made.where = {"m.toml", 3, 1};
    return made;
}

PathEntry to(double east_m, double north_m) {
    auto made = entry();
    made.place = LocalPosition{east_m, north_m};
    return made;
}

PathEntry to_latitude(double latitude_deg, double longitude_deg) {
    auto made = entry();
    made.geographic = GeodeticPosition{latitude_deg, longitude_deg};
    return made;
}

PathEntry circles(PathEntry made, double count, double radius_m) {
    made.circles = count;
    made.radius_m = radius_m;
    return made;
}

PathDefaults defaults() {
    PathDefaults made;
    made.airspeed_m_per_s = 13.0;
    made.where = {"m.toml", 1, 1};
    return made;
}

const Leg& leg(const FlightPath& path, std::size_t index) { return std::get<Leg>(path.elements.at(index).shape); }

TEST(PathEntries, BecomeLegsFromPlaceToPlace) {
    auto home = defaults();
    home.return_to_start = true;
    const auto path = build_path({to(300.0, 0.0), to(300.0, 400.0)}, home);
    ASSERT_EQ(path.elements.size(), 3U);
    EXPECT_DOUBLE_EQ(leg(path, 0).course_deg, 90.0);
    EXPECT_NEAR(leg(path, 1).length_m, 400.0, 1e-9);
    EXPECT_NEAR(leg(path, 2).length_m, 500.0, 1e-9);
    EXPECT_NEAR(leg(path, 2).course_deg, 180.0 + std::atan2(3.0, 4.0) * 180.0 / std::numbers::pi, 1e-9);
    EXPECT_TRUE(path.elements[2].is_return_leg);
    EXPECT_EQ(path.elements[2].name, "return to start");
}

// An ArduPilot's plan that ends with a return to launch, at another height than it began.
TEST(PathEntries, DoNotReturnWhereTheyAreBack) {
    auto home = defaults();
    home.return_to_start = true;
    home.altitude_m = 40.0;
    auto out = to(300.0, 0.0);
    out.altitude_m = 60.0;
    auto back = to(0.0, 0.0);
    back.altitude_m = 60.0;
    EXPECT_EQ(build_path({out, back}, home).elements.size(), 2U);
}

/// The way back of 5 m lost 60 m of height at the airspeed.
TEST(PathEntries, ReturnNoSteeperThanTheModelsFlights) {
    auto home = defaults();
    home.return_to_start = true;
    home.altitude_m = 40.0;
    home.rates_on_spot = {3.0, 2.0};
    auto out = to(300.0, 0.0);
    out.altitude_m = 100.0;
    const auto near = build_path({out, to(5.0, 0.0)}, home).elements;
    ASSERT_EQ(near.size(), 4U);
    EXPECT_EQ(near[2].altitude_change_m, 0.0);
    EXPECT_EQ(near[3].altitude_change_m, -60.0);
    EXPECT_DOUBLE_EQ(std::get<Hold>(near[3].shape).time_s, 30.0);
    EXPECT_TRUE(near[3].is_return_leg);
    const auto far = build_path({out, to(1500.0, 0.0)}, home).elements;
    ASSERT_EQ(far.size(), 3U);
    EXPECT_EQ(far[2].altitude_change_m, -60.0);
}

/// 300 m on a way of 260 m were climbed at 15 m/s, in 20 s.
TEST(PathEntries, WaitForAnAltitudeWhereTheWayIsTooShortForIt) {
    auto home = defaults();
    home.altitude_m = 100.0;
    home.rates_on_spot = {3.0, 2.0};
    auto up = to(260.0, 0.0);
    up.altitude_m = 400.0;
    up.waits_for_altitude = true;
    auto down = to(260.0, 2600.0);
    down.altitude_m = 50.0;
    down.waits_for_altitude = true;
    const auto path = build_path({up, down}, home);
    ASSERT_EQ(path.elements.size(), 3U) << "the second way is long enough";
    EXPECT_DOUBLE_EQ(path.elements[0].altitude_change_m, 60.0) << "20 s at 3 m/s";
    EXPECT_DOUBLE_EQ(path.elements[1].altitude_change_m, 240.0);
    EXPECT_DOUBLE_EQ(std::get<Hold>(path.elements[1].shape).time_s, 80.0);
    EXPECT_DOUBLE_EQ(path.elements[2].altitude_change_m, -350.0);
    down.altitude_m = 0.0;
    const auto longer = build_path({up, down, to(0.0, 0.0)}, home);
    EXPECT_DOUBLE_EQ(longer.elements.at(2).altitude_change_m, -400.0) << "200 s at 2 m/s";
    down.altitude_m = -20.0;
    EXPECT_DOUBLE_EQ(build_path({up, down}, home).elements.at(3).altitude_change_m, -20.0);
    home.rates = {3.0, 3.0};
    EXPECT_EQ(build_path({up, down}, home).elements.size(), 2U) << "at rates that are stated";
}

TEST(PathEntries, CircleAroundAPlaceFromItsEdge) {
    const auto path = build_path({circles(to(1000.0, 0.0), 2.0, 100.0), to(0.0, 0.0)}, defaults());
    ASSERT_EQ(path.elements.size(), 3U);
    EXPECT_NEAR(leg(path, 0).length_m, 900.0, 1e-9);
    const auto& circle = std::get<Circles>(path.elements[1].shape);
    EXPECT_NEAR(circle.start_course_deg, 0.0, 1e-9);  // west of the centre, to the right: north
    EXPECT_NEAR(leg(path, 2).length_m, 900.0, 1e-9);  // from the edge where they end
    // Half a circle more ends on the other side.
    const auto further = build_path({circles(to(1000.0, 0.0), 2.5, 100.0), to(0.0, 0.0)}, defaults());
    EXPECT_NEAR(leg(further, 2).length_m, 1100.0, 1e-9);
    // Without a place the centre is next to the aircraft: a quarter to the left of the way north is to the west of it.
    auto here = circles(entry(), 0.25, 50.0);
    here.to_right = false;
    const auto turned = build_path({to(0.0, 100.0), here, to(-50.0, 150.0), to(-60.0, 150.0)}, defaults());
    ASSERT_EQ(turned.elements.size(), 3U);  // the quarter ends at the next place
    EXPECT_NEAR(leg(turned, 2).length_m, 10.0, 1e-9);
}

TEST(PathEntries, ChangeTheirHeightOnTheWay) {
    auto high = defaults();
    high.altitude_m = 100.0;
    high.rates = {2.0, 1.0};
    auto up = to(500.0, 0.0);
    up.altitude_m = 160.0;
    up.hold_s = 30.0;
    auto down = entry();
    down.altitude_m = 120.0;
    down.hold_s = 60.0;
    auto slow = to(0.0, 0.0);
    slow.altitude_m = 110.0;
    slow.rates.descent_m_per_s = 0.5;
    const auto path = build_path({up, down, slow}, high);
    ASSERT_EQ(path.elements.size(), 4U);
    EXPECT_DOUBLE_EQ(path.elements[0].altitude_change_m, 60.0);
    EXPECT_EQ(path.elements[0].climb_rate_m_per_s, std::optional(2.0));
    EXPECT_DOUBLE_EQ(path.elements[1].altitude_change_m, 0.0);
    EXPECT_DOUBLE_EQ(path.elements[2].altitude_change_m, -40.0);
    EXPECT_EQ(path.elements[2].climb_rate_m_per_s, std::optional(1.0));
    EXPECT_EQ(path.elements[3].climb_rate_m_per_s, std::optional(0.5));
    // Where the aircraft is already, a rate states how long it takes.
    auto above = to(0.0, 0.0);
    above.altitude_m = 150.0;
    const auto on_the_spot = build_path({above}, high);
    EXPECT_DOUBLE_EQ(std::get<Hold>(on_the_spot.elements.at(0).shape).time_s, 25.0);
    // Without an altitude of the path, a first waypoint that is the start has it.
    auto first = to_latitude(43.0, 1.0);
    first.altitude_m = 250.0;
    auto second = to_latitude(43.01, 1.0);
    second.altitude_m = 270.0;
    EXPECT_DOUBLE_EQ(build_path({first, second}, defaults()).elements.at(0).altitude_change_m, 20.0);
}

/// Degrees of WGS84 (NGA.STND.0036, the lengths of a degree at 45 degrees: 111131.745 m and 78846.806 m).
TEST(PathEntries, MeasureDegreesOnTheEllipsoid) {
    const GeodeticPosition origin{45.0, 5.0};
    const auto north = to_local({45.001, 5.0}, origin);
    EXPECT_NEAR(north.north_m, 111.131745, 1e-4);
    EXPECT_NEAR(north.east_m, 0.0, 1e-9);
    const auto east = to_local({45.0, 5.001}, origin);
    EXPECT_NEAR(east.east_m, 78.846806, 1e-4);
    EXPECT_NEAR(east.north_m, 0.0, 1e-3);
    // Across the date line.
    EXPECT_NEAR(to_local({10.0, -179.999}, {10.0, 179.999}).east_m, 219.2, 0.2);
    const auto path = build_path({to_latitude(45.0, 5.0), to_latitude(45.01, 5.0)}, defaults());
    ASSERT_EQ(path.elements.size(), 1U);
    EXPECT_NEAR(leg(path, 0).length_m, 1111.32, 0.02);
}

TEST(PathEntries, RefuseWhatHasNoMeaning) {
    const auto refusal = [](std::vector<PathEntry> entries) {
        return rejected([&] { build_path(entries, defaults()); });
    };
    auto both = to(1.0, 1.0);
    both.length_m = 5.0;
    both.course_deg = 0.0;
    EXPECT_EQ(
        refusal({both}),
        "m.toml:3:1: leg 1: has a place and a length; a leg goes to a place, or so far on a course: give one of them");
    EXPECT_NE(refusal({entry()}).find("is empty"), std::string::npos);
    auto half = entry();
    half.length_m = 5.0;
    EXPECT_NE(refusal({half}).find("length_m and course_deg belong together"), std::string::npos);
    auto round = to(1.0, 1.0);
    round.radius_m = 50.0;
    EXPECT_NE(refusal({round}).find("circles and radius_m belong together"), std::string::npos);
    auto high = to(100.0, 0.0);
    high.altitude_m = 20.0;
    EXPECT_NE(refusal({high}).find("the path has none at its start"), std::string::npos);
    EXPECT_NE(refusal({to(5.0, 5.0), to_latitude(43.0, 1.0)}).find("on a path in metres"), std::string::npos);
    EXPECT_NE(refusal({to_latitude(43.0, 1.0), to(5.0, 5.0)}).find("on a path that has latitudes"), std::string::npos);
    EXPECT_NE(refusal({to_latitude(43.0, 1.0), to_latitude(1.0, 43.0)}).find("the right way round"), std::string::npos);
    EXPECT_NE(refusal({to(0.0, 0.0)}).find("has no leg to fly"), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::path
