#include "flight/track.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::ElementsAre;

TEST(Track, IsSortedFiniteAndWithoutDuplicates) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> time_s{3, 1, 2, 2, 2};
    const std::vector<double> values{30, 10, 21, nan, 23};
    const auto mean = make_track(time_s, values, Merge::mean);
    EXPECT_THAT(mean.time_s, ElementsAre(1, 2, 3));
    EXPECT_THAT(mean.value, ElementsAre(10, 22, 30));
    EXPECT_THAT(make_track(time_s, values, Merge::latest).value, ElementsAre(10, 23, 30));
}

TEST(Track, IsLinearBetweenItsPointsAndConstantBeyond) {
    const Track track{.time_s = {1, 2, 4}, .value = {10, 20, 0}};
    EXPECT_EQ(value_at(track, 0), 10);
    EXPECT_EQ(value_at(track, 1.5), 15);
    EXPECT_EQ(value_at(track, 2), 20);
    EXPECT_EQ(value_at(track, 3), 10);
    EXPECT_EQ(value_at(track, 9), 0);
    EXPECT_EQ(state_at(track, 3.9), 20);
    EXPECT_EQ(state_at(track, 0), 10);
    const std::vector<double> times{0, 1.5, 2, 3, 9};
    EXPECT_THAT(resample(track, times), ElementsAre(10, 15, 20, 10, 0));
}

}  // namespace
}  // namespace flightwatt::flight
