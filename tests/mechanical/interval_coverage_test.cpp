// Intervals are honest: they hold the truth as often as they say.

#include "mechanical/interval_coverage.h"

#include <cstdio>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

void expect_honest(const test::CoverageCase& made, unsigned seed) {
    for (const auto phase : all_phases) {
        const auto coverage = test::coverage_of(phase, made, seed);
        EXPECT_GE(coverage.covered, 0.92) << to_string(phase);
        EXPECT_LE(coverage.covered, 0.98) << to_string(phase);
        EXPECT_EQ(coverage.without_answer, 0U) << to_string(phase);
    }
}

TEST(IntervalCoverage, OfTwoHundredFlightsEachAlone) { expect_honest({}, 1); }

TEST(IntervalCoverage, OfTwoHundredFlightsInFours) { expect_honest({.flights = 800, .together = 4}, 2); }

double cruise_coverage(const test::CoverageCase& made) {
    return test::coverage_of(Phase::cruise, made, 3).covered;
}

TEST(IntervalCoverage, OfLongPhasesWhoseNoiseIsNotIndependent) {
    const double covered = cruise_coverage({.autocorrelation = 0.6});
    EXPECT_GE(covered, 0.92);
    EXPECT_LE(covered, 0.98);
}

TEST(IntervalCoverage, OfRobustFitsWithOutliers) {
    for (const auto loss : {Loss::huber, Loss::cauchy}) {
        const double covered = cruise_coverage({.flights = 60, .loss = loss, .outliers = 0.02});
        EXPECT_GE(covered, 0.88) << to_string(loss);
        EXPECT_LE(covered, 0.995) << to_string(loss);
    }
}

// How to run: mechanical_tests --gtest_also_run_disabled_tests --gtest_filter='*IntervalCoverage*Large*'
TEST(IntervalCoverage, DISABLED_LargeRunPrintsItsFigures) {
    std::printf("phase    noise_w  autocorrelation  together  covered  a0     ratio  at_bound\n");
    for (const auto phase : all_phases) {
        for (const double noise_w : {0.05, 0.24, 1.0}) {
            for (const double autocorrelation : {0.0, 0.4, 0.7}) {
                for (const std::size_t together : {1U, 4U}) {
                    const test::CoverageCase made{.noise_w = noise_w,
                                                  .autocorrelation = autocorrelation,
                                                  .flights = 1000,
                                                  .together = together};
                    const auto coverage = test::coverage_of(phase, made, 7);
                    std::printf("%-8s %7.2f  %15.1f  %8zu  %7.3f  %5.3f  %5.2f  %zu of %zu\n",
                                std::string(to_string(phase)).c_str(), noise_w, autocorrelation, together,
                                coverage.covered, coverage.a0_covered, coverage.mean_error_ratio,
                                coverage.at_bound, coverage.fits);
                    std::fflush(stdout);
                    EXPECT_GT(coverage.covered, 0.5);
                }
            }
        }
    }
}

}  // namespace
}  // namespace flightwatt
