#include "compute/sensors/power_trace.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

/// An AR(1) series around 10 W.
PowerTrace series(double correlation, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise;
    PowerTrace trace;
    double deviation = noise(random);
    for (std::size_t i = 0; i < count; ++i) {
        trace.time_s.push_back(0.1 * static_cast<double>(i));
        trace.power_w.push_back(10.0 + deviation);
        deviation = correlation * deviation + std::sqrt(1.0 - correlation * correlation) * noise(random);
    }
    return trace;
}

TEST(RunStatistics, EnergyIsMeanPowerTimesDuration) {
    const auto run = estimate_run({{0.0, 0.1, 0.2, 0.3}, {1.0, 2.0, 3.0, 6.0}}, 0.4);
    EXPECT_DOUBLE_EQ(run.power_w, 3.0);
    EXPECT_DOUBLE_EQ(run.energy_j, 1.2);
    EXPECT_EQ(run.samples, 4U);
    // A late sample represents the time that it closes, the first for the median interval, 0.3 s.
    EXPECT_NEAR(estimate_run({{0.0, 0.1, 0.4}, {1.0, 1.0, 4.0}}, 0.5).power_w, (0.3 + 0.1 + 1.2) / 0.7, 1e-12);
    const auto single = estimate_run({{0.0}, {5.0}}, 2.0);
    EXPECT_EQ(single.energy_j, 10.0);
    EXPECT_TRUE(std::isnan(single.standard_error_w));  // unknown is not 0
    EXPECT_TRUE(std::isnan(combine_repeats({single}).standard_error_w));
    EXPECT_EQ(combine_repeats({single, estimate_run({{0.0}, {7.0}}, 2.0)}).standard_error_w, 1.0);
}

TEST(RunStatistics, StandardErrorKnowsOfAutocorrelation) {
    // The truth of AR(1): s / sqrt(n) * sqrt((1 + r) / (1 - r)).
    for (const double correlation : {0.0, 0.5, 0.9}) {
        double squared_error = 0.0;
        double reported = 0.0;
        constexpr int seeds = 200;
        constexpr std::size_t count = 1000;
        for (int seed = 0; seed < seeds; ++seed) {
            const auto run = estimate_run(series(correlation, count, static_cast<std::uint64_t>(seed)), 100.0);
            squared_error += (run.power_w - 10.0) * (run.power_w - 10.0) / seeds;
            reported += run.standard_error_w / seeds;
        }
        const double truth = std::sqrt((1.0 + correlation) / (1.0 - correlation) / static_cast<double>(count));
        EXPECT_NEAR(reported, truth, 0.12 * truth) << correlation;
        EXPECT_NEAR(std::sqrt(squared_error), truth, 0.15 * truth) << correlation;
    }
}

TEST(RunStatistics, CombinesRepeats) {
    const auto both = combine_repeats({{10.0, 0.1, 5.0, 50.0, 20, 1}, {12.0, 0.1, 7.0, 84.0, 30, 1}});
    EXPECT_DOUBLE_EQ(both.power_w, 11.0);
    EXPECT_DOUBLE_EQ(both.standard_error_w, 1.0);  // between them: sqrt(2) / sqrt(2)
    EXPECT_DOUBLE_EQ(both.energy_j, 66.0);
    EXPECT_EQ(both.samples, 50U);
    EXPECT_EQ(both.repeats, 2U);
    // Two that happen to agree are not without error.
    EXPECT_NEAR(combine_repeats({{10.0, 0.3, 1, 10, 9, 1}, {10.0, 0.4, 1, 10, 9, 1}}).standard_error_w, 0.25, 1e-12);
}

TEST(RunStatistics, JitterIsThatOfIntervalsWithinRuns) {
    const auto jitter = jitter_of({{{0.0, 1.0, 4.0}, {1, 1, 1}}, {{100.0, 102.0}, {1, 1}}});
    EXPECT_DOUBLE_EQ(jitter.mean_s, 2.0);
    EXPECT_DOUBLE_EQ(jitter.max_s, 3.0);
    EXPECT_DOUBLE_EQ(jitter.sd_s, std::sqrt(2.0 / 3.0));
    EXPECT_EQ(jitter_of({}).mean_s, 0.0);
}

}  // namespace
}  // namespace flightwatt::compute
