#include "mechanical/prediction/energy_estimate.h"

#include "base/statistics.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

EnergyEstimate estimate(double energy_wh, double variance_wh2, double degrees_of_freedom) {
    EnergyEstimate result{energy_wh, true, 0.0, 0.0};
    add_share(result, {variance_wh2, degrees_of_freedom});
    return result;
}

TEST(EnergyEstimate, HasAnIntervalOfItsOneShare) {
    const auto interval = interval_95(estimate(10.0, 4.0, 5.0)).value();
    EXPECT_NEAR(interval.low_wh, 10.0 - 2.0 * 2.5706, 1e-3);
    EXPECT_NEAR(interval.high_wh, 10.0 + 2.0 * 2.5706, 1e-3);
    EXPECT_TRUE(interval.contains(5.0));
    EXPECT_FALSE(interval.contains(15.2));
}

/// Two equal shares of 3 degrees each are as one of 6 (Welch and Satterthwaite).
TEST(EnergyEstimate, AddsVariancesAndDegreesOfFreedom) {
    const auto sum = sum_of(estimate(10.0, 2.0, 3.0), estimate(20.0, 2.0, 3.0));
    EXPECT_DOUBLE_EQ(sum.energy_wh, 30.0);
    EXPECT_NEAR(interval_95(sum).value().high_wh, 30.0 + 2.0 * student_t_half_width(6.0), 1e-9);
}

TEST(EnergyEstimate, WithoutKnownUncertaintyHasNoIntervalNorHasASum) {
    const EnergyEstimate unknown{1.0, false, 0.0, 0.0};
    EXPECT_FALSE(interval_95(unknown).has_value());
    EXPECT_FALSE(interval_95(sum_of(unknown, estimate(1.0, 1.0, 3.0))).has_value());
}

TEST(EnergyEstimate, CannotFallBelowNothing) {
    const auto interval = interval_95(estimate(1.0, 100.0, 2.0)).value();
    EXPECT_DOUBLE_EQ(interval.low_wh, 0.0);
    EXPECT_GT(interval.high_wh, 40.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
