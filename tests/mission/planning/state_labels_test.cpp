#include "helpers/small_missions.h"
#include "mission/plan.h"
#include "mission/planning/schedule_search.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// With a cut-off just below what the least power leads to, most of what a bound promises cannot be flown: plans used
/// to have a twentieth of the utility of plans of the same mission whose choices have to stay for three slots.
TEST(CautiousValueStudy, FindsPlansBeforeALateCutOff) {
    auto free = test::SmallMissionGenerator(71017).make_long(false, true).problem;
    auto staying = free;
    staying.plan.dwell_s = 3.0 * free.plan.slot_s;
    const auto plan = plan_mission(free);
    const auto of_fewer = plan_mission(staying);
    ASSERT_TRUE(plan.plan.feasible && of_fewer.plan.feasible);
    EXPECT_GE(*plan.summary.utility, *of_fewer.summary.utility * (1.0 - 1e-9));
    EXPECT_LE(*plan.summary.utility, plan.plan.utility_bound);
    EXPECT_GE(*plan.summary.utility, 0.99 * plan.plan.utility_bound);
}

}  // namespace
}  // namespace flightwatt::mission
