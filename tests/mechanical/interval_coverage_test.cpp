// Intervals are honest: they hold the truth as often as they say (scripts/bench_coverage: the large run).

#include "helpers/interval_coverage.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

void expect_honest(const test::CoverageCase& made, unsigned seed) {
    for (const auto phase : flight::all_phases) {
        const auto coverage = test::coverage_of(phase, made, seed);
        EXPECT_GE(coverage.covered, 0.92) << to_string(phase);
        EXPECT_LE(coverage.covered, 0.98) << to_string(phase);
        EXPECT_EQ(coverage.without_answer, 0U) << to_string(phase);
    }
}

TEST(IntervalCoverage, OfTwoHundredFlightsEachAlone) { expect_honest({}, 1); }

TEST(IntervalCoverage, OfTwoHundredFlightsInFours) { expect_honest({.flights = 800, .together = 4}, 2); }

double cruise_coverage(const test::CoverageCase& made) {
    return test::coverage_of(flight::Phase::cruise, made, 3).covered;
}

TEST(IntervalCoverage, OfLongPhasesWhoseNoiseIsNotIndependent) {
    const double covered = cruise_coverage({.autocorrelation = 0.6});
    EXPECT_GE(covered, 0.92);
    EXPECT_LE(covered, 0.98);
}

TEST(IntervalCoverage, OfRobustFitsWithOutliers) {
    const double covered = cruise_coverage({.flights = 60, .loss = Loss::huber, .outliers = 0.02});
    EXPECT_GE(covered, 0.88);
    EXPECT_LE(covered, 0.995);
}

}  // namespace
}  // namespace flightwatt::mechanical
