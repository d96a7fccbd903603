#include "path/turns.h"

#include "path/trajectory.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using std::numbers::pi;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double airspeed = 13.0;
const double radius_m = airspeed * airspeed / 9.80665;  // of a bank of 45 degrees: 17.2 m

PathElement element_of(std::variant<Leg, Circles, Hold> shape, const std::string& name = "leg") {
    PathElement element;
    element.shape = shape;
    element.airspeed_m_per_s = airspeed;
    element.name = name;
    return element;
}

FlightPath polygon(int corners, double side_m) {
    FlightPath path;
    for (int i = 0; i < corners; ++i)
        path.elements.push_back(element_of(Leg{side_m, 360.0 / corners * i}, "leg " + std::to_string(i + 1)));
    return path;
}

double flown_m(const FlightPath& path) { return compute_trajectory(path, {}).duration_s * airspeed; }

LocalPosition end_of(const FlightPath& path) { return local_position_at(path, {path.elements.size(), 0.0}); }

/// An arc within a corner takes the place of twice its tangent.
TEST(Turns, CutTheCornersOfPolygons) {
    for (const int corners : {3, 4, 6}) {
        const auto turned = fly_turns(polygon(corners, 400.0), {}, {});
        const double turn = 2.0 * pi / corners;
        const double saved_m = radius_m * (2.0 * std::tan(turn / 2.0) - turn);
        EXPECT_NEAR(flown_m(turned.path), 400.0 * corners - (corners - 1) * saved_m, 1e-6);
        EXPECT_NEAR(std::hypot(end_of(turned.path).east_m, end_of(turned.path).north_m), 0.0, 1e-6);
        EXPECT_TRUE(turned.notes.empty());
    }
}

/// Lines nearer than two radii: bulbs from the end of one to the start of the next, as they are drawn with half circles
/// or with corners.
TEST(Turns, LeaveTheLinesOfASurvey) {
    for (const double spacing_m : {8.0, 25.0}) {
        FlightPath half_circles;
        FlightPath corners;
        for (int line = 0; line < 4; ++line) {
            const double course_deg = line % 2 == 0 ? 0.0 : 180.0;
            if (line > 0) {
                half_circles.elements.push_back(
                    element_of(Circles{spacing_m / 2.0, 0.5, line % 2 == 1, 180.0 - course_deg}, "survey"));
                half_circles.elements.back().is_turn = true;
                corners.elements.push_back(element_of(Leg{spacing_m, 90.0}, "way"));
            }
            for (auto* path : {&half_circles, &corners})
                path->elements.push_back(element_of(Leg{300.0, course_deg}, "line " + std::to_string(line + 1)));
        }
        const double out = std::acos((spacing_m + 2.0 * radius_m) / (4.0 * radius_m));
        const double all_m = 4.0 * 300.0 + 3.0 * radius_m * (pi + 4.0 * out);
        for (const auto& drawn : {half_circles, corners}) {
            const auto turned = fly_turns(drawn, {}, {});
            EXPECT_NEAR(flown_m(turned.path), all_m, 1e-4) << spacing_m;
            EXPECT_NEAR(end_of(turned.path).east_m, 3.0 * spacing_m, 1e-5);
            EXPECT_THAT(turned.notes, ElementsAre(HasSubstr("a radius of 17.23 m (a bank of 45 degrees)")));
        }
    }
}

TEST(Turns, FollowHalfCirclesThatAreWideEnough) {
    FlightPath drawn{
        {element_of(Leg{300.0, 0.0}), element_of(Circles{20.0, 0.5, true, 0.0}), element_of(Leg{300.0, 180.0})}};
    drawn.elements[1].is_turn = true;
    const auto turned = fly_turns(drawn, {}, {});
    EXPECT_NEAR(flown_m(turned.path), 600.0 + pi * 20.0, 1e-6);
    EXPECT_TRUE(turned.notes.empty());
}

TEST(Turns, FlyOverSharpCornersAndReturn) {
    const FlightPath there_and_back{{element_of(Leg{900.0, 60.0}, "leg 1"), element_of(Leg{900.0, 240.0}, "leg 2")}};
    const auto turned = fly_turns(there_and_back, {}, {});
    EXPECT_NEAR(std::hypot(end_of(turned.path).east_m, end_of(turned.path).north_m), 0.0, 1e-5);
    const double added_m = flown_m(turned.path) - 1800.0;
    EXPECT_GT(added_m, pi * radius_m);
    EXPECT_LT(added_m, 2.0 * pi * radius_m);
    EXPECT_TRUE(turned.notes.empty()) << "no limit binds: a corner so sharp is always flown over";
}

/// As autopilots count: from the entry on, wherever that is.
TEST(Turns, FlyCirclesAsOftenAsStated) {
    const Circles stated{100.0, 2.0, true, 270.0};
    const FlightPath drawn{{element_of(Leg{500.0, 0.0}), element_of(stated), element_of(Leg{400.0, 0.0})}};
    const auto turned = fly_turns(drawn, {}, {});
    double most_turns = 0.0;
    double legs_m = 0.0;
    for (const auto& element : turned.path.elements) {
        if (const auto* circles = std::get_if<Circles>(&element.shape))
            most_turns = std::max(most_turns, circles->turns);
        else
            legs_m += std::get<Leg>(element.shape).length_m;
    }
    EXPECT_DOUBLE_EQ(most_turns, stated.turns);
    EXPECT_GT(legs_m, 900.0 - stated.radius_m);
    EXPECT_NEAR(end_of(turned.path).north_m, end_of(drawn).north_m, 1e-4);
    EXPECT_NEAR(end_of(turned.path).east_m, end_of(drawn).east_m, 1e-4);
}

TEST(Turns, CarryTheHeightOfCirclesOnce) {
    FlightPath drawn{{element_of(Circles{100.0, 1.0, true, 0.0}), element_of(Circles{100.0, 1.0, false, 90.0})}};
    drawn.elements.back().altitude_change_m = 30.0;
    double height_m = 0.0;
    for (const auto& element : fly_turns(drawn, {}, {}).path.elements) height_m += element.altitude_change_m;
    EXPECT_DOUBLE_EQ(height_m, 30.0);
}

TEST(Turns, NeverBankMoreThanTheLimit) {
    const Wind wind{6.0, 250.0};
    FlightPath drawn = polygon(5, 30.0);
    drawn.elements.push_back(element_of(Circles{10.0, 3.0, true, 0.0}, "leg 6"));
    drawn.elements.push_back(element_of(Leg{12.0, 200.0}));
    for (const double bank_deg : {25.0, 45.0}) {
        const auto turned = fly_turns(drawn, wind, {.max_bank_deg = bank_deg});
        const double most = 1.0 / std::cos(bank_deg * pi / 180.0);
        for (const auto& piece : compute_trajectory(turned.path, wind).pieces)
            EXPECT_LE(piece.motion.load_factor, most + 1e-9);
        EXPECT_THAT(turned.notes, testing::Contains(HasSubstr("leg 6: circles of 10 m need a bank of more than")));
    }
}

/// Without a jump of place or course from part to part.
TEST(Turns, AreSmooth) {
    FlightPath drawn = polygon(7, 45.0);
    drawn.elements.push_back(element_of(Circles{60.0, 1.25, false, 100.0}));
    drawn.elements.push_back(element_of(Leg{15.0, 0.0}));
    drawn.elements.push_back(element_of(Leg{500.0, 260.0}));
    const auto turned = fly_turns(drawn, {}, {});
    double course_deg = 0.0;
    for (const auto& element : turned.path.elements) {
        const auto* arc = std::get_if<Circles>(&element.shape);
        const double start_deg = arc != nullptr ? arc->start_course_deg : std::get<Leg>(element.shape).course_deg;
        EXPECT_NEAR(std::remainder(start_deg - course_deg, 360.0), 0.0, 0.11);
        course_deg = start_deg + (arc == nullptr ? 0.0 : (arc->to_right ? 360.0 : -360.0) * arc->turns);
    }
    EXPECT_NEAR(end_of(turned.path).north_m, end_of(drawn).north_m, 1e-4);
}

TEST(Turns, KeepChangesOfHeightAndTheirRates) {
    auto drawn = polygon(4, 100.0);
    drawn.elements[1].altitude_change_m = 10.0;
    drawn.elements[1].climb_rate_m_per_s = 2.0;
    drawn.elements[2].altitude_change_m = 14.0;  // fits into the leg, and not into what the arcs leave of it
    drawn.elements[2].climb_rate_m_per_s = 2.0;
    const auto turned = fly_turns(drawn, {}, {});
    double climbed_m = 0.0;
    for (const auto& piece : compute_trajectory(turned.path, {}).pieces) {
        climbed_m += piece.time_s * piece.motion.climb_m_per_s;
        EXPECT_LE(piece.motion.climb_m_per_s, 3.0);
    }
    EXPECT_NEAR(climbed_m, 24.0, 1e-6);
}

TEST(Turns, TakeTheStatedRadius) {
    const auto turned = fly_turns(polygon(4, 400.0), {}, {.radius_m = 50.0});
    EXPECT_NEAR(flown_m(turned.path), 1600.0 - 3.0 * 50.0 * (2.0 - pi / 2.0), 1e-6);
}

/// A rotorcraft stops and starts with a limited jerk, and between short legs never reaches its speed. A real ArduCopter
/// of these limits reached 10 m/s after 6.5 s.
TEST(Turns, CostARotorcraftItsBraking) {
    constexpr double acceleration = 2.5;
    constexpr double jerk = 1.0;
    const auto flown_s = [](const std::vector<PathElement>& elements) {
        return compute_trajectory(fly_turns({elements}, {}, {.is_rotorcraft = true}).path, {}).duration_s;
    };
    const double change_s = airspeed / acceleration + acceleration / jerk;
    EXPECT_NEAR(flown_s({element_of(Leg{200.0, 0.0})}), 200.0 / airspeed + change_s, 1e-6);
    // Its highest speed v is reached after 2 sqrt(v / jerk), on half of the way: 2 v^1.5 = 12 m.
    EXPECT_NEAR(flown_s({element_of(Leg{12.0, 0.0})}), 4.0 * std::cbrt(6.0), 1e-6);
    const auto stops = flown_s({element_of(Leg{200.0, 0.0}), element_of(Hold{5.0}), element_of(Leg{200.0, 0.0})});
    EXPECT_NEAR(stops, 400.0 / airspeed + 5.0 + 2.0 * change_s, 1e-6);
    // At a corner the changes before and behind it overlap.
    EXPECT_NEAR(flown_s({element_of(Leg{200.0, 0.0}), element_of(Leg{200.0, 180.0})}),
                400.0 / airspeed + change_s + airspeed / acceleration, 0.1);
    EXPECT_NEAR(flown_s({element_of(Leg{500.0, 0.0}), element_of(Leg{500.0, 3.0})}), 1000.0 / airspeed + change_s, 0.3);
}

TEST(Turns, SlowARotorcraftOnNarrowCircles) {
    const auto turned = fly_turns({{element_of(Circles{5.0, 2.0})}}, {}, {.is_rotorcraft = true});
    EXPECT_NEAR(turned.path.elements.front().airspeed_m_per_s, std::sqrt(9.80665 * 5.0), 1e-9);
    EXPECT_THAT(turned.notes, ElementsAre(HasSubstr("circles of 5 m are flown at 7 m/s")));
}

TEST(Turns, CircleAsFastAsTheBankPermits) {
    const TurnLimits rotorcraft{true};
    EXPECT_NEAR(circle_time_s(100.0, 5.0, {}, rotorcraft), 2.0 * pi * 100.0 / 5.0, 1e-6);
    EXPECT_NEAR(circle_time_s(2.0, 5.0, {3.0, 90.0}, rotorcraft), 2.0 * pi * 2.0 / std::sqrt(9.80665 * 2.0), 1e-6);
    EXPECT_NEAR(circle_time_s(5.0, airspeed, {}, {}), 2.0 * pi * radius_m / airspeed, 1e-6) << "of a wing: wider";
}

TEST(Turns, OfARotorcraftThatKeepsItsGroundSpeedAreThoseOfCalmAir) {
    FlightPath drawn{{element_of(Leg{90.0, 0.0}), element_of(Leg{60.0, 120.0}), element_of(Circles{5.0, 2.0})}};
    for (auto& element : drawn.elements) element.keeps_ground_speed = true;
    const auto flown_s = [&](const Wind& wind) {
        return compute_trajectory(fly_turns(drawn, wind, {.is_rotorcraft = true}).path, wind).duration_s;
    };
    EXPECT_NEAR(flown_s({9.0, 200.0}), flown_s({}), 1e-9);
}

}  // namespace
}  // namespace flightwatt::path
