#include "mission/mission.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// Ten minutes of cruise with a detection that may run at 30 FPS for the first 200 s.
Mission short_detection() {
    Mission mission;
    mission.duration_s[flight::Phase::cruise] = 600.0;
    mission.utilities = {Utility{0, 1.0, UtilityShape::linear, {}, {}}};
    mission.schedule = {{flight::Phase::cruise, 0.0, 200.0, {{0, {30.0}}}},
                        {flight::Phase::cruise, 200.0, 600.0, {}}};
    return mission;
}

TEST(MissionUtility, IsTheMeanOverTheWholeMission) {
    auto mission = short_detection();
    EXPECT_DOUBLE_EQ(*mean_utility(mission, mission.schedule, 600.0), 10.0);
    EXPECT_DOUBLE_EQ(*mean_utility(mission, mission.schedule, 100.0), 5.0);
    mission.utilities = {std::nullopt};
    EXPECT_FALSE(mean_utility(mission, mission.schedule, 600.0));
}

TEST(AnyMission, HasASetupWhateverItIs) {
    PlanningProblem problem;
    problem.name = "to be planned";
    EXPECT_EQ(setup_of(problem).name, "to be planned");
    EXPECT_EQ(setup_of(short_detection()).duration_s[flight::Phase::cruise], 600.0);
}

}  // namespace
}  // namespace flightwatt::mission
