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
        {{flight::Phase::cruise, 0.0, 150.0, slow}, {flight::Phase::cruise, 150.0, 600.0, fast}},
        {{28.0, 600.0, 60.0}}, {{28.0, 900.1, 60.0}});
    EXPECT_DOUBLE_EQ(longer[0].end_s, 225.025);
    EXPECT_EQ(longer[1].start_s, longer[0].end_s);
    EXPECT_EQ(longer[1].end_s, 900.1) << "exactly the end of the phase";
}

}  // namespace
}  // namespace flightwatt::mission
