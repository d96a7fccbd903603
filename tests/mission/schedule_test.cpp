#include "mission/schedule.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

const compute::Configuration slow{{0, {5.0}}};
const compute::Configuration fast{{0, {30.0}}};

TEST(Schedule, JoinsNeighboursThatRunTheSame) {
    std::vector<ScheduleSegment> schedule;
    append_merged(schedule, {flight::Phase::takeoff, 0.0, 28.0, slow});
    append_merged(schedule, {flight::Phase::cruise, 0.0, 10.0, slow});
    append_merged(schedule, {flight::Phase::cruise, 10.0, 20.0, slow});
    append_merged(schedule, {flight::Phase::cruise, 20.0, 30.0, fast});
    EXPECT_EQ(schedule, (std::vector<ScheduleSegment>{{flight::Phase::takeoff, 0.0, 28.0, slow},
                                                      {flight::Phase::cruise, 0.0, 20.0, slow},
                                                      {flight::Phase::cruise, 20.0, 30.0, fast}}));
    EXPECT_EQ(configurations_of(schedule), (std::vector<compute::Configuration>{slow, fast}));
}

TEST(Schedule, KeepsItsPartsOfAPhaseFlownLonger) {
    const auto longer = rescale_to_flown_durations(
        {{flight::Phase::cruise, 0.0, 150.0, slow}, {flight::Phase::cruise, 150.0, 600.0, fast}}, {{28.0, 600.0, 60.0}},
        {{28.0, 900.1, 60.0}});
    EXPECT_DOUBLE_EQ(longer[0].end_s, 225.025);
    EXPECT_EQ(longer[1].start_s, longer[0].end_s);
    EXPECT_EQ(longer[1].end_s, 900.1) << "exactly the end of the phase";
}

const flight::PerPhase<double> durations{{100.0, 600.0, 50.0}};

TEST(Timeline, StartsEachPhaseWhereTheOneBeforeEnds) {
    const auto timeline = timeline_of(durations);
    EXPECT_EQ(timeline.start_s.values, (std::array{0.0, 100.0, 700.0}));
    EXPECT_EQ(timeline.end_s.values, (std::array{100.0, 700.0, 750.0}));
    EXPECT_EQ(timeline.duration_s, 750.0);
    const auto cruise_alone = timeline_of({{0.0, 600.0, 0.0}});
    EXPECT_EQ(cruise_alone.start_s[flight::Phase::landing], cruise_alone.end_s[flight::Phase::landing]);
}

TEST(Timeline, RescalesTimesToTheSamePartOfAPhase) {
    const flight::PerPhase<double> flown{{100.0, 900.0, 25.0}};
    EXPECT_DOUBLE_EQ(rescale_to_flown_durations_s(50.0, durations, flown), 50.0);
    EXPECT_DOUBLE_EQ(rescale_to_flown_durations_s(400.0, durations, flown), 550.0);
    EXPECT_DOUBLE_EQ(rescale_to_flown_durations_s(725.0, durations, flown), 1012.5);
    EXPECT_DOUBLE_EQ(rescale_to_flown_durations_s(750.0, durations, flown), 1025.0);
}

}  // namespace
}  // namespace flightwatt::mission
