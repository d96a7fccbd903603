#include "report/sections/plan_section.h"

#include "helpers/paper_missions.h"
#include "report/figures/plan_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

mission::AnyMission paper(const std::string& name) {
    return mission::read_mission(test::paper_mission_path(name), {true, std::nullopt});
}

TEST(PlanSection, IsEmptyWhereNothingWasPlanned) {
    EXPECT_TRUE(plan_section(simulate_for_report({paper("phased")})).figures.empty());
}

TEST(PlanSection, ShowsThePlanBesideMissionsOfItsKind) {
    const auto missions = simulate_for_report(
        {paper("plan"), paper("phased"), paper("computing-only"), paper("mechanical-only")});
    ASSERT_TRUE(missions[0].planned);
    EXPECT_TRUE(missions[0].planned->feasible);
    EXPECT_FALSE(missions[1].planned);
    const auto section = plan_section(missions);
    ASSERT_EQ(section.figures.size(), 2U);
    EXPECT_EQ(section.figures[0].id, "plan-1-strip");
    EXPECT_EQ(section.figures[1].id, "plan-1-worth");
    EXPECT_THAT(section.html, HasSubstr("proven bound"));
    EXPECT_THAT(section.html, HasSubstr("<td class=\"text\">optimal</td>"));
    const auto spec = section.figures[1].spec.dump();
    for (const auto* text : {"phased", "reserve", "proven bound"}) EXPECT_THAT(spec, HasSubstr(text));
    EXPECT_THAT(spec, testing::Not(HasSubstr("computing-only"))) << "another flight";
    EXPECT_THAT(spec, testing::Not(HasSubstr("mechanical-only"))) << "other software";
}

TEST(PlanSection, SaysWhereNoPlanKeepsTheReserve) {
    auto mission = test::paper_problem("plan");
    mission.reserve_soc_percent = 60.0;
    const auto missions = simulate_for_report({mission});
    EXPECT_FALSE(missions[0].planned->feasible);
    const auto html = plan_section(missions).html;
    EXPECT_THAT(html, HasSubstr("No schedule that keeps the reserve was found"));
    EXPECT_THAT(html, HasSubstr(">no</td>"));
}

TEST(RunningTimes, JoinEqualNeighboursOverPhases) {
    const auto mission = test::paper_mission("adaptive");
    const auto times = running_times(mission);
    ASSERT_EQ(times.size(), 6U) << "two components: little, much, little";
    EXPECT_EQ(times[0].start_s, 0.0);
    EXPECT_NEAR(times[2].end_s - times[2].start_s, 120.0, 1e-9);
    EXPECT_EQ(describe_qos(mission.compute.components[times[2].component], times[2].qos), "fps 32");
    EXPECT_NEAR(times[4].end_s, 688.0, 1.0);
}

}  // namespace
}  // namespace flightwatt::report
