#include "path/path.h"

#include <cstddef>
#include <optional>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

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

TEST(Path, KnowsWhereAPlaceLies) {
    const FlightPath path{{element_of(Leg{1000.0, 0.0}, 10.0), element_of(Leg{1000.0, 90.0}, 10.0)}};
    EXPECT_NEAR(local_position_at(path, {0, 0.5}).north_m, 500.0, 1e-9);
    EXPECT_NEAR(local_position_at(path, {1, 0.25}).east_m, 250.0, 1e-9);
    EXPECT_NEAR(local_position_at(path, {2, 0.0}).north_m, 1000.0, 1e-9);
    for (const bool right : {true, false}) {
        const FlightPath circle{{element_of(Circles{100.0, 2.0, right, 0.0})}};
        EXPECT_NEAR(local_position_at(circle, {0, 0.5}).east_m, 0.0, 1e-6) << "a whole turn";
        const auto half = local_position_at(circle, {0, 0.25});
        EXPECT_NEAR(half.east_m, right ? 200.0 : -200.0, 1e-6) << "across";
        EXPECT_NEAR(half.north_m, 0.0, 1e-6);
    }
}

TEST(Path, HasDistancesAndCoursesBetweenPlaces) {
    const LocalPosition a{1.0, 2.0};
    const LocalPosition b{-2.0, 6.0};
    EXPECT_DOUBLE_EQ(distance_between_m(a, b), 5.0);
    EXPECT_NEAR(course_between(a, {1.0, 1.0}), 180.0, 1e-9);
    EXPECT_NEAR(course_between(a, {0.0, 2.0}), -90.0, 1e-9);
    EXPECT_DOUBLE_EQ(scalar_product(a, b), 10.0);
}

TEST(Path, LeadsThereAndBack) {
    FlightPath path{
        {element_of(Leg{300.0, 90.0}), element_of(Circles{50.0, 1.0}), climbing(element_of(Leg{400.0, 0.0}), 40.0)}};
    EXPECT_DOUBLE_EQ(length_of_legs_m(path), 700.0);
    const auto turned = out_and_back(path, 400.0, {});
    ASSERT_EQ(turned.elements.size(), 5U);
    const auto& back = turned.elements;
    EXPECT_DOUBLE_EQ(std::get<Leg>(back[2].shape).length_m, 100.0);
    EXPECT_DOUBLE_EQ(back[2].altitude_change_m, 10.0);
    EXPECT_DOUBLE_EQ(std::get<Leg>(back[3].shape).course_deg, 180.0);
    EXPECT_DOUBLE_EQ(back[3].altitude_change_m, -10.0);
    EXPECT_DOUBLE_EQ(std::get<Leg>(back[4].shape).course_deg, 270.0);
    EXPECT_DOUBLE_EQ(std::get<Leg>(back[4].shape).length_m, 300.0);
    EXPECT_EQ(out_and_back(path, 300.0, {}).elements.size(), 2U);
}

TEST(Path, TurnsBackAtItsEndWhateverItsLengthsRoundTo) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> length_m(1.0, 2000.0);
    for (int i = 0; i < 200; ++i) {
        FlightPath path;
        for (int leg = 0; leg < 5; ++leg) path.elements.push_back(element_of(Leg{length_m(random), 10.0 * leg}));
        path.elements.push_back(element_of(Hold{60.0}));  // begins where the path turns back: is not flown
        EXPECT_EQ(out_and_back(path, length_of_legs_m(path), {}).elements.size(), 10U) << i;
    }
}

/// A path in parts is the whole path: places, heights and shapes.
TEST(Path, IsTheSumOfItsParts) {
    auto hold = element_of(Hold{100.0, Leg{500.0, 45.0}});
    const FlightPath path{
        {climbing(element_of(Leg{300.0, 90.0}), 20.0), element_of(Circles{50.0, 3.0, false, 30.0}), hold}};
    const std::vector<PathPosition> cuts{{0, 0.0}, {0, 0.25}, {1, 0.5}, {1, 0.75}, {2, 0.1}, {3, 0.0}};
    FlightPath all;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
        const auto part = path_between(path, cuts[i - 1], cuts[i]);
        all.elements.insert(all.elements.end(), part.elements.begin(), part.elements.end());
        const auto place = local_position_at(path, cuts[i]);
        const auto reached = local_position_at(all, {all.elements.size(), 0.0});
        EXPECT_NEAR(reached.east_m, place.east_m, 1e-9) << i;
        EXPECT_NEAR(reached.north_m, place.north_m, 1e-9) << i;
    }
    ASSERT_EQ(all.elements.size(), 7U);
    EXPECT_DOUBLE_EQ(all.elements[0].altitude_change_m, 5.0);
    EXPECT_DOUBLE_EQ(all.elements[1].altitude_change_m, 15.0);
    EXPECT_FALSE(all.elements[1].climb_rate_m_per_s);
    EXPECT_DOUBLE_EQ(std::get<Circles>(all.elements[3].shape).turns, 0.75);
    EXPECT_DOUBLE_EQ(std::get<Hold>(all.elements[6].shape).time_s, 90.0);
    EXPECT_EQ(path_between(path, {0, 0.0}, {0, 0.0}).elements.size(), 0U);
}

}  // namespace
}  // namespace flightwatt::path
