#include "mission/timeline.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

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
