#include "mechanical/fit/phase_samples.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(MeanPower, WeighsSamplesByTime) {
    const PhaseSamples samples{"f", 100.0, {0.1, 0.2, 0.8}, {10.0, 10.0, 20.0}};
    EXPECT_NEAR(mean_power_w(samples), 10.0 * 0.2 + 15.0 * 0.6 + 20.0 * 0.2, 1e-12);
}

TEST(MedianGap, CountsNoGapBetweenEqualTimes) {
    EXPECT_DOUBLE_EQ(median_gap({0.5, 0.1, 0.1, 0.2, 0.8}), 0.3);
    EXPECT_EQ(median_gap({0.5, 0.5}), 0.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
