#include "cli/output/replay_output.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using mission::ScheduleMethod;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

mission::ReplayedSchedule ended(ScheduleMethod way, double soc_percent, double utility) {
    mission::ReplayedSchedule schedule;
    schedule.way = way;
    schedule.summary.final_soc_percent = soc_percent;
    schedule.summary.utility = utility;
    schedule.summary.feasible = true;
    schedule.summary.duration_s = 600.0;
    schedule.summary.reserve_soc_percent = 20.0;
    schedule.summary.keeps_reserve = soc_percent >= 20.0;
    return schedule;
}

mission::ReplayedSchedule emptied(ScheduleMethod way, double at_s) {
    auto schedule = ended(way, 0.0, 10.0);
    schedule.summary.feasible = false;
    schedule.summary.depleted_at_s = at_s;
    return schedule;
}

mission::Replay replay_of(const std::string& flight, mission::ReplayedSchedule planned,
                          mission::ReplayedSchedule replanned) {
    mission::Replay replay;
    replay.flight = flight;
    replay.mission = "survey";
    replay.model = "others";
    replay.model_flights = {"x"};
    replay.schedules = {std::move(planned), std::move(replanned)};
    return replay;
}

std::vector<mission::Replay> all_cases() {
    constexpr auto planned = ScheduleMethod::planned;
    constexpr auto replanned = ScheduleMethod::replanned;
    return {replay_of("saved", ended(planned, 12.0, 30.0), ended(replanned, 20.5, 27.0)),
            replay_of("spent", ended(planned, 30.0, 20.0), ended(replanned, 21.0, 24.0)),
            replay_of("tied", ended(planned, 20.2, 25.0), ended(replanned, 20.4, 24.99)),
            replay_of("hoarded", ended(planned, 20.0, 25.0), ended(replanned, 22.0, 24.0)),
            replay_of("lost", ended(planned, 20.0, 25.0), ended(replanned, 19.0, 26.0)),
            replay_of("hopeless", emptied(planned, 500.0), emptied(replanned, 550.0))};
}

TEST(ReplaySentences, CountTheFlightsOnWhichItWasBetter) {
    EXPECT_THAT(replay_sentences(all_cases()),
                ElementsAre("survey: replanning in flight against planning before the flight: better on 3 of 6, a tie "
                            "on 1, worse on 2; it keeps the reserve on 4, the plan on 4."))
        << "there is no plan with a margin";
}

TEST(ReplayCsv, LeavesEmptyWhatIsNot) {
    const std::vector replays{all_cases()[5]};
    EXPECT_THAT(replay_csv(replays), HasSubstr("\nhopeless,survey,planned,,,0,20,false,0,0,0,0,600,500,,10,,,,\n"));
}

TEST(ReplayTable, TellsWhereASchedulesBatteryEnded) {
    const auto table = replay_table(all_cases());
    ASSERT_EQ(table.rows.size(), 12U);
    ASSERT_THAT(table.header, Contains("reserve kept"));
    const auto kept = std::ranges::find(table.header, "reserve kept") - table.header.begin();
    const auto empty = std::ranges::find(table.header, "empty at [s]") - table.header.begin();
    EXPECT_EQ(table.rows[0].at(kept), "no");
    EXPECT_EQ(table.rows[1].at(kept), "yes");
    EXPECT_EQ(table.rows[10].at(empty), "500.0");
}

TEST(ReplayBasis, SaysWhatTheModelSaw) {
    auto replay = all_cases()[0];
    const auto overlap = [&] { return replay_basis_table(std::vector{replay}).rows[0][3]; };
    EXPECT_EQ(overlap(), "no");
    replay.model_saw_flight = mission::TrainingOverlap::yes;
    EXPECT_EQ(overlap(), "yes");
    replay.model_saw_flight = mission::TrainingOverlap::unknown;
    EXPECT_EQ(overlap(), "unknown");
}

}  // namespace
}  // namespace flightwatt::cli
