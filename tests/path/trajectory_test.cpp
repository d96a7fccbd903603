#include "path/trajectory.h"

#include "helpers/rejected.h"

#include <cmath>
#include <numbers>
#include <random>

#include <boost/math/special_functions/ellint_2.hpp>
#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using std::numbers::pi;

constexpr double gravity = 9.80665;

PathElement element_of(std::variant<Leg, Circles, Hold> shape, double airspeed = 13.0) {
    PathElement element;
    element.shape = shape;
    element.airspeed_m_per_s = airspeed;
    element.name = "leg 1";
    element.where = {"m.toml", 7, 1};
    return element;
}

PathElement climbing(PathElement element, double change_m, std::optional<double> rate = {}) {
    element.altitude_change_m = change_m;
    element.climb_rate_m_per_s = rate;
    return element;
}

double time_s(const PathElement& element, const Wind& wind = {}) {
    return compute_trajectory({{element}}, wind).duration_s;
}

std::optional<double> level_ground_speed(double airspeed, double course_deg, const Wind& wind) {
    return ground_speed_m_per_s(element_of(Leg{}, airspeed), 0.0, course_deg, wind);
}

double climbed_m(const PathTrajectory& flown) {
    double sum_m = 0.0;
    for (const auto& piece : flown.pieces) sum_m += piece.time_s * piece.motion.climb_m_per_s;
    return sum_m;
}

TEST(Trajectory, GroundSpeedsFollowTheWindTriangle) {
    const Wind wind{5.0, 270.0};  // from the west
    EXPECT_DOUBLE_EQ(level_ground_speed(13.0, 90.0, wind).value(), 18.0);
    EXPECT_DOUBLE_EQ(level_ground_speed(13.0, 270.0, wind).value(), 8.0);
    EXPECT_DOUBLE_EQ(level_ground_speed(13.0, 0.0, wind).value(), 12.0);  // 5, 12, 13
    EXPECT_NEAR(level_ground_speed(13.0, 180.0, wind).value(), 12.0, 1e-12);
    EXPECT_FALSE(level_ground_speed(5.0, 0.0, wind));
    EXPECT_FALSE(level_ground_speed(5.0, 270.0, wind));
    EXPECT_FALSE(level_ground_speed(6.0, 320.0, {8.0, 270.0}));
    EXPECT_NEAR(time_s(element_of(Leg{1200.0, 0.0}), wind), 100.0, 1e-9);
}

/// The heading that a ground speed implies moves the aircraft as its airspeed and the wind do.
TEST(Trajectory, GroundSpeedsAddUpAsVectors) {
    std::mt19937 random(20261);
    std::uniform_real_distribution<double> angle(0.0, 360.0);
    std::uniform_real_distribution<double> speed(0.0, 12.0);
    for (int i = 0; i < 200; ++i) {
        const Wind wind{speed(random), angle(random)};
        const double course_rad = angle(random) * pi / 180.0;
        const double ground = level_ground_speed(12.5, course_rad * 180.0 / pi, wind).value();
        const double from_rad = wind.from_deg * pi / 180.0;
        const double east = ground * std::sin(course_rad) + wind.speed_m_per_s * std::sin(from_rad);
        const double north = ground * std::cos(course_rad) + wind.speed_m_per_s * std::cos(from_rad);
        EXPECT_NEAR(std::hypot(east, north), 12.5, 1e-9);
    }
}

PathElement over_ground(PathElement element) {
    element.keeps_ground_speed = true;
    return element;
}

/// A rotorcraft at 8 m/s over ground: with the wind, against it and across.
TEST(Trajectory, KeptGroundSpeedsChangeTheAirspeedInsteadOfTheTime) {
    const Wind wind{6.0, 180.0};  // from the south
    for (const auto& [course_deg, airspeed] : {std::pair{0.0, 2.0}, {180.0, 14.0}, {90.0, 10.0}}) {
        const auto flown = compute_trajectory({{over_ground(element_of(Leg{400.0, course_deg}, 8.0))}}, wind);
        ASSERT_EQ(flown.pieces.size(), 1U);
        EXPECT_NEAR(flown.duration_s, 50.0, 1e-9);
        EXPECT_NEAR(flown.pieces.front().motion.airspeed_m_per_s, airspeed, 1e-9);
    }
    const auto blown = compute_trajectory({{over_ground(element_of(Leg{400.0, 180.0}, 5.0))}}, wind);
    EXPECT_NEAR(blown.duration_s, 80.0, 1e-9) << "a wind above the speed does not forbid a leg";
    const auto climbs = compute_trajectory({{over_ground(climbing(element_of(Leg{400.0, 180.0}, 5.0), 300.0))}}, wind);
    EXPECT_NEAR(climbs.duration_s, 100.0, 1e-6) << "4 m/s over ground and 3 m/s up";
    EXPECT_NEAR(climbs.pieces.front().motion.airspeed_m_per_s, std::hypot(10.0, 3.0), 1e-6);
    // Against the wind, 400 m in a measured time of 100 s.
    const auto measured =
        compute_trajectory({{over_ground(element_of(Hold{100.0, Leg{400.0, 180.0}, false}, 4.0))}}, wind);
    EXPECT_NEAR(measured.duration_s, 100.0, 1e-9);
    EXPECT_NEAR(measured.pieces.front().motion.airspeed_m_per_s, 10.0, 1e-9);
}

/// Around whole circles the mean square of the airspeed is that of both speeds, over parts what small steps give.
TEST(Trajectory, KeptGroundSpeedsAroundCirclesChangeTheAirspeedWithTheCourse) {
    const Wind wind{3.0, 250.0};
    for (const double turns : {2.0, 0.4}) {
        const auto flown =
            compute_trajectory({{over_ground(element_of(Circles{40.0, turns, false, 30.0}, 7.0))}}, wind);
        const double length_m = turns * 2.0 * pi * 40.0;
        EXPECT_NEAR(flown.duration_s, length_m / 7.0, 1e-9);
        double flown_sum = 0.0;
        for (const auto& piece : flown.pieces) {
            flown_sum += piece.time_s * std::pow(piece.motion.airspeed_m_per_s, 2);
            EXPECT_NEAR(piece.motion.load_factor, std::hypot(1.0, 49.0 / (gravity * 40.0)), 1e-9);
        }
        constexpr int steps = 10000;
        double stepped_sum = 0.0;
        for (int k = 0; k < steps; ++k) {
            const double course_rad = 30.0 * pi / 180.0 - 2.0 * pi * turns * (k + 0.5) / steps;
            const double to_rad = 70.0 * pi / 180.0;
            stepped_sum += flown.duration_s / steps * (49.0 + 9.0 - 42.0 * std::cos(course_rad - to_rad));
        }
        EXPECT_NEAR(flown_sum, stepped_sum, 1e-5 * stepped_sum);
    }
}

/// A path that ends at its start, cut short, still does.
TEST(Repeated, AFractionOfAPathThatReturnsReturnsToo) {
    const FlightPath round{{element_of(Leg{300.0, 0.0}), element_of(Leg{400.0, 90.0}),
                            element_of(Leg{500.0, std::atan2(-400.0, -300.0) * 180.0 / pi})}};
    const auto half_s = compute_trajectory(repeated(round, {}, 0.5), {}).duration_s;
    EXPECT_NEAR(half_s, (600.0 + std::hypot(300.0, 300.0)) / 13.0, 1e-6);
    EXPECT_NEAR(compute_trajectory(repeated(round, {}, 2.0), {}).duration_s, 2400.0 / 13.0, 1e-6);
    const FlightPath there{{element_of(Leg{300.0, 0.0})}};
    EXPECT_NEAR(compute_trajectory(repeated(there, {}, 0.5), {}).duration_s, 150.0 / 13.0, 1e-6);
    EXPECT_NEAR(compute_trajectory(repeated(there, {}, 1.5), {}).duration_s, 600.0 / 13.0, 1e-6);
}

/// The way home was as steep as the airspeed: 300 m of height in its last metres saved a battery on paper.
TEST(Repeated, ReturnsNoSteeperThanTheRates) {
    FlightPath round{{element_of(Leg{300.0, 0.0}), element_of(Leg{300.0, 180.0})}};
    round.elements.front().altitude_change_m = 100.0;
    const ClimbRates rates{2.0, 1.5};
    const auto short_of = repeated(round, {}, 0.99, rates);
    ASSERT_EQ(short_of.elements.size(), 4U);
    EXPECT_EQ(short_of.elements[2].altitude_change_m, 0.0);
    EXPECT_NEAR(std::get<Hold>(short_of.elements[3].shape).time_s, 100.0 / 1.5, 1e-9);
    EXPECT_NEAR(short_of.elements[3].altitude_change_m, -100.0, 1e-9);
    EXPECT_EQ(repeated(round, {}, 1.0, rates).elements.size(), 2U) << "the landing is from its end";
    const auto twice = repeated(round, {}, 2.0, rates);
    ASSERT_EQ(twice.elements.size(), 5U);
    EXPECT_NEAR(twice.elements[2].altitude_change_m, -100.0, 1e-9) << "each time begins as high";
    round.elements.front().altitude_change_m = 10.0;
    EXPECT_EQ(repeated(round, {}, 0.5, rates).elements.size(), 2U);
}

TEST(Trajectory, CirclesInCalmAirTakeTheirLength) {
    const auto flown = compute_trajectory({{element_of(Circles{75.0, 2.5})}}, {});
    ASSERT_EQ(flown.pieces.size(), 1U);
    EXPECT_NEAR(flown.duration_s, 2.5 * 2.0 * pi * 75.0 / 13.0, 1e-9);
    const double tangent = 13.0 * 13.0 / (gravity * 75.0);
    EXPECT_NEAR(flown.pieces.front().motion.load_factor, std::sqrt(1.0 + tangent * tangent), 1e-12);
}

/// 1 / g = (sqrt(V^2 - w^2 sin^2) - w cos) / (V^2 - w^2): around a circle the complete elliptic integral.
TEST(Trajectory, CirclesInWindTakeTheEllipticIntegral) {
    for (const double wind : {0.5, 3.0, 8.0, 12.5}) {
        const double airspeed = 13.0;
        const double exact_s =
            60.0 * 4.0 * airspeed * boost::math::ellint_2(wind / airspeed) / (airspeed * airspeed - wind * wind);
        for (const double start_deg : {0.0, 77.0, 200.0})
            for (const bool to_right : {true, false})
                EXPECT_NEAR(time_s(element_of(Circles{60.0, 3.0, to_right, start_deg}), {wind, 40.0}) / (3.0 * exact_s),
                            1.0, 1e-9)
                    << wind;
    }
}

/// A turn in small steps: the heading's rate of change is what the bank has to give.
TEST(Trajectory, LoadFactorsInWindAreThoseOfTheTurn) {
    const double airspeed = 13.0;
    const double radius_m = 50.0;
    const double wind = 4.0;
    const auto flown = compute_trajectory({{element_of(Circles{radius_m, 1.0}, airspeed)}}, {wind, 180.0});
    double mean_square = 0.0;
    for (const auto& piece : flown.pieces)
        mean_square += std::pow(piece.motion.load_factor, 2) * piece.time_s / flown.duration_s;
    const int steps = 200000;
    double sum = 0.0;
    double total_s = 0.0;
    const auto heading = [&](double course) { return course + std::asin(wind * std::sin(course) / airspeed); };
    for (int k = 0; k < steps; ++k) {
        const double course = 2.0 * pi * (k + 0.5) / steps;
        const double step = 2.0 * pi / steps;
        const double ground = wind * std::cos(course) +
                              std::sqrt(airspeed * airspeed - std::pow(wind * std::sin(course), 2));  // tailwind at 0
        const double step_s = radius_m * step / ground;
        const double turn_rate = (heading(course + step / 2.0) - heading(course - step / 2.0)) / step_s;
        sum += (1.0 + std::pow(airspeed * turn_rate / gravity, 2)) * step_s;
        total_s += step_s;
    }
    EXPECT_NEAR(flown.duration_s, total_s, 1e-6);
    EXPECT_NEAR(mean_square, sum / total_s, 1e-6);
    EXPECT_GT(flown.pieces.size(), 8U);
}

TEST(Trajectory, PartsOfCirclesAddUpToTheWhole) {
    const Wind wind{6.0, 300.0};
    const double whole_s = time_s(element_of(Circles{80.0, 1.0, true, 30.0}), wind);
    double sum_s = 0.0;
    for (int part = 0; part < 5; ++part)
        sum_s += time_s(element_of(Circles{80.0, 0.2, true, 30.0 + 72.0 * part}), wind);
    EXPECT_NEAR(sum_s, whole_s, 1e-8);
    // Very many circles have longer pieces, and the same sums.
    const auto many = compute_trajectory({{element_of(Circles{80.0, 5000.5, true, 30.0})}}, wind);
    EXPECT_LT(many.pieces.size(), 300U);
    EXPECT_NEAR(many.duration_s, 5000.0 * whole_s + time_s(element_of(Circles{80.0, 0.5, true, 30.0}), wind), 1e-4);
}

TEST(Trajectory, AnyWindMakesARoundTripLonger) {
    std::mt19937 random(20262);
    std::uniform_real_distribution<double> angle(0.0, 360.0);
    std::uniform_real_distribution<double> speed(0.1, 11.0);
    const FlightPath square{{element_of(Leg{500.0, 0.0}), element_of(Leg{500.0, 90.0}), element_of(Leg{500.0, 180.0}),
                             element_of(Leg{500.0, 270.0}), element_of(Circles{60.0, 2.0})}};
    const double calm_s = compute_trajectory(square, {}).duration_s;
    for (int i = 0; i < 50; ++i)
        EXPECT_GT(compute_trajectory(square, {speed(random), angle(random)}).duration_s, calm_s);
}

TEST(Trajectory, ClimbsSpreadOverALegArriveAtItsEnd) {
    // Calm: along the slope.
    EXPECT_NEAR(time_s(climbing(element_of(Leg{400.0, 0.0}), 300.0)), 500.0 / 13.0, 1e-9);
    for (const Wind wind : {Wind{6.0, 10.0}, Wind{6.0, 100.0}, Wind{6.0, 190.0}}) {
        const auto flown = compute_trajectory({{climbing(element_of(Leg{900.0, 0.0}), -120.0)}}, wind);
        ASSERT_EQ(flown.pieces.size(), 1U);
        const double climb = flown.pieces.front().motion.climb_m_per_s;
        const double horizontal = std::sqrt(13.0 * 13.0 - climb * climb);
        EXPECT_NEAR(climb * flown.duration_s, -120.0, 1e-7);
        EXPECT_NEAR(flown.duration_s, 900.0 / level_ground_speed(horizontal, 0.0, wind).value(), 1e-7);
    }
    const auto circling = compute_trajectory({{climbing(element_of(Circles{80.0, 4.0}), 60.0)}}, {5.0, 0.0});
    EXPECT_NEAR(climbed_m(circling), 60.0, 1e-6);
}

TEST(Trajectory, ClimbsAtARateComeFirst) {
    const Wind wind{4.0, 0.0};
    const auto flown = compute_trajectory({{climbing(element_of(Leg{1000.0, 0.0}), 60.0, 2.0)}}, wind);
    ASSERT_EQ(flown.pieces.size(), 2U);
    EXPECT_NEAR(flown.pieces[0].time_s, 30.0, 1e-9);
    const double climbed_over_m = 30.0 * (std::sqrt(13.0 * 13.0 - 4.0) - 4.0);
    EXPECT_NEAR(flown.pieces[1].time_s, (1000.0 - climbed_over_m) / 9.0, 1e-9);
    EXPECT_EQ(flown.pieces[1].motion.climb_m_per_s, 0.0);
    const auto circling = compute_trajectory({{climbing(element_of(Circles{80.0, 3.0}), -60.0, 1.5)}}, wind);
    EXPECT_NEAR(climbed_m(circling), -60.0, 1e-6);
    const auto holding = compute_trajectory({{climbing(element_of(Hold{100.0}), 60.0, 2.0)}}, wind);
    EXPECT_NEAR(holding.duration_s, 100.0, 1e-12);
    EXPECT_NEAR(climbed_m(holding), 60.0, 1e-9);
}

TEST(Trajectory, HoversWithTheSpeedOfTheWind) {
    Hold hover{100.0};
    hover.hovers = true;
    const auto airspeed_in = [&](const Wind& wind) {
        return compute_trajectory({{element_of(hover)}}, wind).pieces.front().motion.airspeed_m_per_s;
    };
    EXPECT_EQ(airspeed_in({}), 0.0);
    EXPECT_EQ(airspeed_in({8.0, 120.0}), 8.0);
    const auto climb = compute_trajectory({{climbing(element_of(hover), 60.0, 3.0)}}, {4.0, 0.0});
    ASSERT_EQ(climb.pieces.size(), 2U);
    EXPECT_DOUBLE_EQ(climb.pieces[0].motion.airspeed_m_per_s, 5.0) << "4 m/s across, 3 m/s up";
    EXPECT_DOUBLE_EQ(climb.pieces[1].motion.airspeed_m_per_s, 4.0);
    EXPECT_EQ(compute_trajectory({{element_of(Hold{100.0})}}, {}).pieces.front().motion.airspeed_m_per_s, 13.0);
}

/// A plan at 2 m/s around a building was refused, as its height changes at 3 m/s above one place.
TEST(Trajectory, ChangesTheHeightInHoverFasterThanTheAirspeedOfItsWays) {
    Hold hover{10.0};
    hover.hovers = true;
    const auto up = compute_trajectory({{climbing(element_of(hover), 200.0)}}, {});
    ASSERT_EQ(up.pieces.size(), 1U);
    EXPECT_DOUBLE_EQ(up.pieces[0].motion.climb_m_per_s, 20.0);
    EXPECT_DOUBLE_EQ(up.pieces[0].time_s, 10.0);
    EXPECT_NE(test::rejected([] {
                  compute_trajectory({{climbing(element_of(Hold{10.0}), 200.0)}}, {});
              }).find("changes its height at 20 m/s with an airspeed of 13 m/s"),
              std::string::npos)
        << "a wing";
}

TEST(Trajectory, RefusesWhatCannotBeFlown) {
    const auto refusal = [](const PathElement& element, const Wind& wind = {}) {
        return test::rejected([&] { compute_trajectory({{element}}, wind); });
    };
    EXPECT_EQ(refusal(element_of(Leg{100.0, 0.0}), {14.0, 90.0}),
              "m.toml:7:1: leg 1: the wind of 14 m/s from 90 degrees is too strong for an airspeed of 13 m/s; fly it "
              "faster, on another course, or on another day");
    EXPECT_NE(refusal(element_of(Leg{100.0, 0.0}), {13.5, 10.0}).find("too strong"), std::string::npos);
    EXPECT_EQ(refusal(element_of(Leg{100.0, 0.0}), {14.0, 180.0}), "");  // a tailwind is no error
    EXPECT_NE(refusal(element_of(Circles{50.0, 1.0}), {13.0, 0.0}).find("too strong"), std::string::npos);
    EXPECT_NE(refusal(climbing(element_of(Leg{100.0, 0.0}), 60.0, 2.0)).find("takes 30 s, and is flown in 7.7"),
              std::string::npos);
    EXPECT_NE(refusal(climbing(element_of(Leg{100.0, 0.0}), 60.0, 14.0)).find("changes its height at 14 m/s"),
              std::string::npos);
    EXPECT_NE(refusal(climbing(element_of(Leg{10.0, 0.0}), 900.0), {6.0, 180.0}).find("too steep"), std::string::npos);
    EXPECT_NE(refusal(climbing(element_of(Hold{10.0}), 60.0, 2.0)).find("need 30 s"), std::string::npos);
    EXPECT_NE(refusal(element_of(Leg{1e6, 0.0}), {12.9999999, 0.0}).find("more than 1e+07"), std::string::npos);
}

TEST(Trajectory, CrawlsAgainstAWindThatWasDrawn) {
    const FlightPath path{{element_of(Leg{100.0, 180.0}), element_of(Leg{100.0, 0.0})}};
    const auto flown = compute_trajectory(path, {14.0, 0.0}, InfeasibleLegPolicy::crawl);
    EXPECT_EQ(flown.infeasible_elements, std::vector<std::size_t>{1});
    EXPECT_NEAR(flown.element_s[1], 100.0 / (0.02 * 13.0), 1e-9);
    // A leg that a tailwind makes too short for its climb is climbed on the spot.
    const auto climbed = compute_trajectory({{climbing(element_of(Leg{300.0, 0.0}), 40.0, 2.0)}}, {10.0, 180.0},
                                            InfeasibleLegPolicy::crawl);
    EXPECT_TRUE(climbed.infeasible_elements.empty());
    EXPECT_NEAR(climbed.duration_s, 20.0, 1e-9);
}

}  // namespace
}  // namespace flightwatt::path
