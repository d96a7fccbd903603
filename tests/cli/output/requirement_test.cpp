// What --require demands of a mission.

#include "cli/output/requirement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

mission::MissionSummary landed() {
    mission::MissionSummary summary;
    summary.mission = "survey";
    summary.final_soc_percent = 40.0;
    summary.feasible = summary.keeps_reserve = true;
    return summary;
}

TEST(Requirement, IsMissedWhereAPartIsUncertain) {
    const Requirement as_modelled{.text = "reserve", .probability = {}};
    auto summary = landed();
    EXPECT_FALSE(reason_missed(as_modelled, summary));
    summary.uncertain = {"the plan is not flown as it is: item 3"};
    EXPECT_THAT(reason_missed(as_modelled, summary).value(),
                HasSubstr("survey: whether it keeps the reserve is uncertain: the plan is not flown"));
    EXPECT_FALSE(reason_missed({}, summary)) << "nothing is required";
}

TEST(Requirement, OfAProbabilityIsMissedWithoutKnownVariability) {
    const Requirement likely{.text = "reserve=0.95", .probability = 0.95};
    auto summary = landed();
    EXPECT_THAT(reason_missed(likely, summary).value(), HasSubstr("unknown"));
    summary.samples = mission::MonteCarloResult{};
    summary.samples->probability_below_reserve = 0.04;
    EXPECT_FALSE(reason_missed(likely, summary));
    summary.samples->probability_below_reserve = 0.06;
    EXPECT_THAT(reason_missed(likely, summary).value(), HasSubstr("with probability 0.9400, required 0.95"));
}

}  // namespace
}  // namespace flightwatt::cli
