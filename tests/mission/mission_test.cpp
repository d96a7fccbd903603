#include "mission/mission.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// Ten minutes of cruise with a detection that may run at 30 FPS for the first 200 s.
Mission short_detection() {
    Mission mission;
    mission.setup.duration_s[flight::Phase::cruise] = 600.0;
    mission.setup.utilities = {Utility{0, 1.0, UtilityShape::linear, {}, {}}};
    mission.schedule = {{flight::Phase::cruise, 0.0, 200.0, {{0, {30.0}}}}, {flight::Phase::cruise, 200.0, 600.0, {}}};
    return mission;
}

TEST(MissionUtility, IsTheMeanOverTheWholeMission) {
    auto mission = short_detection();
    EXPECT_DOUBLE_EQ(*mean_utility(mission.setup, mission.schedule, 600.0), 10.0);
    EXPECT_DOUBLE_EQ(*mean_utility(mission.setup, mission.schedule, 100.0), 5.0);
    mission.setup.utilities = {std::nullopt};
    EXPECT_FALSE(mean_utility(mission.setup, mission.schedule, 600.0));
}

TEST(AnyMission, HasASetupWhateverItIs) {
    PlanningProblem problem;
    problem.setup.name = "to be planned";
    EXPECT_EQ(setup_of(problem).name, "to be planned");
    EXPECT_EQ(setup_of(short_detection()).duration_s[flight::Phase::cruise], 600.0);
}

Utility shaped(UtilityShape shape, double weight = 1.0) { return {0, weight, shape, {}, {}}; }

TEST(Utility, FollowsItsShape) {
    EXPECT_DOUBLE_EQ(utility_per_s(shaped(UtilityShape::linear, 2.5), {20.0}), 50.0);
    EXPECT_DOUBLE_EQ(utility_per_s(shaped(UtilityShape::square_root), {25.0}), 5.0);
    EXPECT_DOUBLE_EQ(utility_per_s(shaped(UtilityShape::logarithm, 2.0), {20.0}), 2.0 * std::log(21.0));
    const Utility points{0, 2.0, UtilityShape::points, {0.0, 10.0, 20.0}, {0.0, 1.0, 5.0}};
    EXPECT_DOUBLE_EQ(utility_per_s(points, {15.0}), 6.0);
    EXPECT_DOUBLE_EQ(utility_per_s(points, {20.0}), 10.0);
}

TEST(Utility, IsTheWeightWithoutAParameter) {
    const Utility constant{std::nullopt, 3.0, UtilityShape::linear, {}, {}};
    EXPECT_EQ(utility_per_s(constant, {}), 3.0);
}

TEST(Utility, SumsWhatRuns) {
    const std::vector<std::optional<Utility>> utilities{shaped(UtilityShape::linear), std::nullopt,
                                                        shaped(UtilityShape::linear, 0.5)};
    EXPECT_EQ(utility_per_s(utilities, {{0, {10.0}}, {1, {99.0}}, {2, {4.0}}}), 12.0);
    EXPECT_EQ(utility_per_s(utilities, {}), 0.0);
    EXPECT_EQ(utility_per_s(std::vector<std::optional<Utility>>{}, {{0, {10.0}}}), 0.0)
        << "a mission that states no utility";
}

}  // namespace
}  // namespace flightwatt::mission
