#include "base/text.h"

#include <limits>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(DurationText, IsWhatPeopleSay) {
    EXPECT_EQ(duration_text(0.0), "0.0 s");
    EXPECT_EQ(duration_text(28.261000000000003), "28.3 s");
    EXPECT_EQ(duration_text(1711.858676), "28 min 32 s");
    EXPECT_EQ(duration_text(3785.0), "1 h 3 min 5 s");
    EXPECT_EQ(duration_text(3605.0), "1 h 0 min 5 s");
    EXPECT_EQ(duration_text(-90.0), "-1 min 30 s");
}

TEST(DurationText, LeavesLastPartsOutThatAreNothing) {
    EXPECT_EQ(duration_text(1680.0), "28 min");
    EXPECT_EQ(duration_text(3780.0), "1 h 3 min");
    EXPECT_EQ(duration_text(7200.0), "2 h");
}

TEST(DurationText, NeverSaysSixty) {
    EXPECT_EQ(duration_text(59.94), "59.9 s");
    EXPECT_EQ(duration_text(59.96), "1 min");
    EXPECT_EQ(duration_text(119.7), "2 min");
    EXPECT_EQ(duration_text(3599.7), "1 h");
}

TEST(DurationText, TellsWhatIsNoDurationAsItIs) {
    EXPECT_EQ(duration_text(std::numeric_limits<double>::quiet_NaN()), "nan s");
    EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "inf s");
}

}  // namespace
}  // namespace flightwatt
