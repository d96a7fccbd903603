#include "report/replay_section.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

mission::ReplayedSchedule replayed(mission::ScheduleMethod way, double soc_percent, double utility) {
    mission::ReplayedSchedule schedule;
    schedule.way = way;
    schedule.summary.final_soc_percent = soc_percent;
    schedule.summary.utility = utility;
    schedule.summary.feasible = true;
    schedule.summary.reserve_soc_percent = 20.0;
    schedule.summary.keeps_reserve = soc_percent >= 20.0;
    return schedule;
}

mission::Replay planned_replay(const std::string& flight) {
    mission::Replay replay;
    replay.flight = flight;
    replay.mission = "survey";
    replay.schedules = {replayed(mission::ScheduleMethod::planned, 15.0, 30.0),
                        replayed(mission::ScheduleMethod::replanned, 21.0, 25.0),
                        replayed(mission::ScheduleMethod::hindsight, 20.0, 26.0)};
    replay.notes = {"power measured <below> 0"};
    return replay;
}

TEST(ReplaySection, ShowsTablesSentencesAndAFigureOfEachMissionToBePlanned) {
    const std::vector replays{planned_replay("one"), planned_replay("two")};
    const auto section = replay_section(replays);
    ASSERT_EQ(section.figures.size(), 1U);
    EXPECT_EQ(section.figures[0].id, "replay-1");
    EXPECT_THAT(section.figures[0].description, HasSubstr("two, replanned: 25 at 21.00 %."));
    EXPECT_THAT(section.html, HasSubstr("better on 2"));
    EXPECT_THAT(section.html, HasSubstr("only replanning keeps the reserve"));
    EXPECT_THAT(section.html, HasSubstr("&lt;below&gt;"));
    EXPECT_THAT(section.html, HasSubstr("were not aboard"));
}

TEST(ReplaySection, DrawsNothingOfAGivenScheduleAlone) {
    auto replay = planned_replay("one");
    replay.schedules = {replayed(mission::ScheduleMethod::given, 15.0, 30.0)};
    const std::vector replays{replay};
    const auto section = replay_section(replays);
    EXPECT_TRUE(section.figures.empty());
    EXPECT_THAT(section.html, HasSubstr("given"));
    EXPECT_THAT(section.html, Not(HasSubstr("replanning in flight against")));
}

}  // namespace
}  // namespace flightwatt::report
