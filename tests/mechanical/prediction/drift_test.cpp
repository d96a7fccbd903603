#include "mechanical/prediction/drift.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// The same by summing the covariance over all pairs of moments.
double summed_covariance(const Drift& drift, double from_a, double to_a, double from_b, double to_b) {
    constexpr int points = 2000;
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
            const double a = from_a + (to_a - from_a) * (i + 0.5) / points;
            const double b = from_b + (to_b - from_b) * (j + 0.5) / points;
            sum += std::exp(-std::abs(a - b) / drift.correlation_s);
        }
    }
    return drift.sd_w * drift.sd_w * sum / points / points;
}

TEST(Drift, AgreesWithTheSumOverAllPairs) {
    const Drift drift{3.0, 40.0};
    EXPECT_NEAR(variance_of_mean_w2(drift, 100.0), summed_covariance(drift, 0, 100, 0, 100), 1e-4);
    EXPECT_NEAR(covariance_of_means_w2(drift, 30.0, 100.0), summed_covariance(drift, 0, 30, 30, 130), 1e-4);
}

TEST(Drift, HasItsLimits) {
    const Drift drift{3.0, 40.0};
    EXPECT_NEAR(variance_of_mean_w2(drift, 1e-9), 9.0, 1e-9);
    EXPECT_NEAR(variance_of_mean_w2(drift, 0.00399), variance_of_mean_w2(drift, 0.00401), 2e-6);
    EXPECT_NEAR(variance_of_mean_w2(drift, 4e6) * 4e6, 9.0 * 2.0 * 40.0, 0.1);
    EXPECT_NEAR(covariance_of_means_w2(drift, 1e-12, 1e-12), 9.0, 1e-9);
}

/// Var of the whole mean is made of the parts' variances and their covariance.
TEST(Drift, IsOneProcessOverBothStretches) {
    const Drift drift{2.0, 70.0};
    const double u = 300.0;
    const double r = 500.0;
    const double whole = (u * u * variance_of_mean_w2(drift, u) + r * r * variance_of_mean_w2(drift, r) +
                          2.0 * u * r * covariance_of_means_w2(drift, u, r)) /
                         ((u + r) * (u + r));
    EXPECT_NEAR(variance_of_mean_w2(drift, u + r), whole, 1e-12);
}

}  // namespace
}  // namespace flightwatt::mechanical
