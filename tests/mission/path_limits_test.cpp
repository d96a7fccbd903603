#include "mission/path_limits.h"

#include "helpers/path_missions.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"

#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::path_element;
using test::path_mission;

MissionVariant with_reserve(Mission mission, double reserve_percent) {
    mission.reserve_soc_percent = reserve_percent;
    return mission;
}

TEST(PathLimits, CountTheCirclesThatTheReserveAllows) {
    const auto mission_of = [](double circles) {
        return with_reserve(path_mission({{path_element(Leg{1300.0, 0.0}), path_element(Circles{100.0, circles}),
                                           path_element(Leg{1300.0, 180.0})}}),
                            30.0);
    };
    const auto most = max_circles(mission_of);
    const auto model = test::made_up_wing();
    const double tangent = 13.0 * 13.0 / (9.80665 * 100.0);
    const double circle_j = 2.0 * std::numbers::pi * 100.0 / 13.0 * (21.97 + 40.0 * tangent * tangent / 13.0);
    EXPECT_EQ(most.value, std::floor((0.7 * 36000.0 - 2.0 * 100.0 * 21.97) / circle_j));
    EXPECT_EQ(most.limited_by, LimitingFactor::charge);
    EXPECT_NEAR(most.final_soc_percent,
                simulate(std::get<Mission>(mission_of(most.value))).summary.final_soc_percent.value(), 1e-12);
    EXPECT_EQ(default_criterion(std::get<Mission>(mission_of(3.0)).cruise_path->plan->path), ReachCriterion::circles);
    const auto too_far = [&](double circles) { return with_reserve(std::get<Mission>(mission_of(circles)), 90.0); };
    EXPECT_THROW(max_circles(too_far), NoResultError);
}

TEST(PathLimits, FindTheFarthestPlaceToReturnFrom) {
    const FlightPath path{{path_element(Leg{6000.0, 0.0}), path_element(Leg{9000.0, 90.0})}};
    const Wind wind{5.0, 0.0};
    EXPECT_EQ(default_criterion(path), ReachCriterion::way_back);
    const auto mission_of = [&](double after_m) {
        return with_reserve(path_mission(out_and_back(path, after_m, {}), wind), 20.0);
    };
    const auto most = farthest_return(mission_of, length_of_legs_m(path));
    // 8 m/s out, 18 back, and 12 across the wind, at 21.97 W.
    const double across_s = 0.8 * 36000.0 / 21.97 - 6000.0 / 8.0 - 6000.0 / 18.0;
    EXPECT_NEAR(most.value, 6000.0 + 12.0 * across_s / 2.0, 1e-3);
    EXPECT_NEAR(most.residual_percent, 0.0, 1e-5);
    // From the end of a short path.
    const FlightPath near{{path_element(Leg{600.0, 0.0})}};
    const auto all = farthest_return(
        [&](double after_m) { return with_reserve(path_mission(out_and_back(near, after_m, {})), 20.0); }, 600.0);
    EXPECT_EQ(all.value, 600.0);
    EXPECT_THROW(farthest_return(mission_of, 0.0), NoResultError);
    // The wind forbids the way back.
    const auto downwind = [&](double after_m) {
        return with_reserve(path_mission(out_and_back(near, after_m, {}), {14.0, 180.0}), 20.0);
    };
    EXPECT_THROW(farthest_return(downwind, 600.0), InputError);
}

/// Out across the wind, and then with a wind that forbids that way back.
TEST(PathLimits, StopWhereTheWindForbidsTheWayBack) {
    const FlightPath path{{path_element(Leg{600.0, 90.0}), path_element(Leg{600.0, 0.0})}};
    const Wind wind{12.9, 180.0};
    const auto most = farthest_return(
        [&](double after_m) {
            return with_reserve(
                path_mission(out_and_back(path, after_m, {}), after_m > 600.0 ? Wind{14.0, 180.0} : wind), 20.0);
        },
        length_of_legs_m(path));
    EXPECT_NEAR(most.value, 600.0, 1e-5);
    EXPECT_GT(most.final_soc_percent, 20.0);
}

TEST(PathLimits, KeepTheReserveWithAChance) {
    const auto mission_of = [](double circles) {
        auto mission = path_mission({{path_element(Circles{100.0, circles})}}, {3.0, 0.0, 1.0, 10.0});
        mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 4.0;
        return with_reserve(std::move(mission), 30.0);
    };
    const auto certain = max_circles(mission_of);
    const auto likely = max_circles(mission_of, 0.95);
    EXPECT_LT(likely.value, certain.value);
    ASSERT_TRUE(likely.sources);
    EXPECT_GT(likely.margin_percent, 0.0);
    EXPECT_GE(likely.residual_percent, -1e-6);
    const auto spare_percent = [&](double circles) {
        const auto mission = std::get<Mission>(mission_of(circles));
        return draw_landings(mission, collect_uncertainty(mission)).spare_percent(0.95);
    };
    EXPECT_GE(spare_percent(likely.value), 0.0);
    EXPECT_LT(spare_percent(likely.value + 1.0), 0.0);
    // One more would not keep it: less than what the margin asks for is left.
    EXPECT_LT(likely.residual_percent, 3.0);
}

}  // namespace
}  // namespace flightwatt::mission
