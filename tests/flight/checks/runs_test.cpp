#include "flight/checks/runs.h"

#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(Runs, EndWhereARuleDoesOrItsNeighbourDiffers) {
    const std::vector<double> values{1, 1, 2, 2, 2, 3};
    EXPECT_EQ(runs_of_equal(values, 1).size(), 3U);
    const auto equal = runs_of_equal(values, 3);
    ASSERT_EQ(equal.size(), 1U);
    EXPECT_EQ(equal[0].begin, 2U);
    EXPECT_EQ(equal[0].end, 5U);
    const auto even = runs_of({1, 6}, [&](std::size_t i) { return values[i] == 2.0; });
    ASSERT_EQ(even.size(), 1U);
    EXPECT_EQ(even[0].size(), 3U);
    EXPECT_TRUE(runs_of({2, 2}, [](std::size_t) { return true; }).empty());
}

TEST(Runs, LastFromSampleToSampleButNotOverGaps) {
    const std::vector<double> time_s{0, 1, 2, 5, 6, 7};
    const auto always = [](std::size_t) { return true; };
    EXPECT_EQ(time_where(time_s, {0, 6}, 2.0, always), 4.0);
    EXPECT_EQ(time_where(time_s, {0, 6}, 3.0, always), 7.0);
    EXPECT_EQ(time_where(time_s, {0, 6}, 3.0, [](std::size_t i) { return i != 1; }), 5.0);
}

}  // namespace
}  // namespace flightwatt::flight
