// Intervals are honest: they hold the truth as often as they state (studies/coverage: the large run).

#include "helpers/interval_coverage.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// Few fits: by chance the parts are off by a few points.
void expect_honest(const test::CoverageCase& made, unsigned seed) {
    for (const auto phase : {flight::Phase::takeoff, flight::Phase::landing}) {
        const auto coverage = test::coverage_of(phase, made, seed);
        EXPECT_GE(coverage.covered, 0.90) << to_string(phase);
        EXPECT_GE(coverage.a0_covered, 0.80) << to_string(phase);
        EXPECT_LT(coverage.worst_curve_error_w, 5.0) << to_string(phase) << ": a wrong frequency is further off";
        EXPECT_EQ(coverage.without_answer, 0U) << to_string(phase);
    }
}

TEST(IntervalCoverageStudy, OfSingleFlights) { expect_honest({.noise_w = 1.0, .flights = 16}, 1); }

TEST(IntervalCoverage, OfFlightsInFours) {
    expect_honest({.noise_w = 0.24, .autocorrelation = 0.4, .flights = 160, .together = 4}, 2);
}

double cruise_coverage(const test::CoverageCase& made) {
    return test::coverage_of(flight::Phase::cruise, made, 3).covered;
}

TEST(IntervalCoverageStudy, OfLongPhasesWhoseNoiseIsNotIndependent) {
    EXPECT_GE(cruise_coverage({.autocorrelation = 0.6, .flights = 8}), 0.85);
}

}  // namespace
}  // namespace flightwatt::mechanical
