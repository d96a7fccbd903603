#include "mechanical/fit/frequency_scan.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

std::vector<PhaseSamples> one_flight(const PhaseModel& phase, double noise_w, unsigned seed) {
    std::mt19937 random(seed);
    return {test::centred(test::record(phase, {phase.duration_s, 0.1, noise_w, 0.0}, random))};
}

TEST(FrequencyScan, CoversTheRangeAndAgreesWithTheExactSums) {
    const auto flights = one_flight(test::cruise_of(4.2, {2.0, 0.6, 0.3}, {1.0, -0.2, 0.4}), 1.0, 1);
    const FrequencyRange range{std::numbers::pi, 200.0};
    const auto scan = scan_frequencies(flights, 3, range);
    EXPECT_LE(scan.grid.step_rad * 3.0, 1.0);
    EXPECT_LT(scan.grid.theta_rad(0) - range.low_rad, scan.grid.step_rad);
    EXPECT_NEAR(scan.grid.theta_rad(scan.grid.size() - 1), range.high_rad, 1e-9);
    for (std::size_t i = 0; i < scan.grid.size(); i += 7) {
        const double exact = projected_square_sum(flights, 3, scan.grid.theta_rad(i));
        EXPECT_NEAR(scan.square_sum[i], exact, 1e-8 * exact) << scan.grid.theta_rad(i);
    }
}

TEST(FrequencyScan, NamesItsMinimaLowestFirst) {
    const FrequencyScan scan{{1, 1.0, 4, 9}, {3.0, 5.0, 2.0, 4.0, 6.0, 1.0}};
    const auto found = minima(scan);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].theta_rad, 9.0);  // an end of the range
    EXPECT_EQ(found[1].theta_rad, 6.0);
    EXPECT_EQ(found[2].square_sum, 3.0);
    EXPECT_EQ(lowest_between(scan, 4.5, 7.0).theta_rad, 6.0);
    EXPECT_TRUE(std::isinf(lowest_between(scan, 10.0, 11.0).square_sum));
}

}  // namespace
}  // namespace flightwatt::mechanical
