#include "compute/leave_one_out.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

TEST(LeaveOneOut, SummarizesTheNodesThatWereFound) {
    const auto summary = summarize_errors("m", {1.0, std::nan(""), -3.0}, {10.0, 5.0, 20.0});
    EXPECT_EQ(summary.nodes, 2U);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_w, 2.0);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_percent, 12.5);
    EXPECT_DOUBLE_EQ(summary.rms_w, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(summary.largest_w, 3.0);
}

TEST(LeaveOneOut, OfNoNodeIsZero) { EXPECT_EQ(summarize_errors("m", {std::nan("")}, {1.0}).rms_w, 0.0); }

}  // namespace
}  // namespace flightwatt::compute
