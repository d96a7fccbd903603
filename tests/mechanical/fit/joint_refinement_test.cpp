#include "mechanical/fit/joint_refinement.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/projected_fit.h"

#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

const FrequencyRange wide{std::numbers::pi, 500.0};

TEST(JointRefinement, StandsAtAMinimum) {
    std::vector<ScaledSamples> flights;
    for (const auto& samples : test::record_flights(flight::Phase::cruise, 4, 0.5, 1))
        flights.push_back(test::centred(samples));
    const auto fit = refine_jointly(flights, 3, wide, 5.0);
    double sum = 0.0;
    for (const double part : fit.square_sum) sum += part;
    EXPECT_NEAR(sum, projected_square_sum(flights, 3, fit.theta_rad), 1e-9 * sum);
    EXPECT_LT(sum, projected_square_sum(flights, 3, fit.theta_rad - 1e-3));
    EXPECT_LT(sum, projected_square_sum(flights, 3, fit.theta_rad + 1e-3));
}

TEST(JointRefinement, StaysInTheRange) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(2.0, {3.0}, {2.0});
    const std::vector flights{test::centred(test::record(phase, {600.0, 1.0, 0.1, 0.0}, random))};
    const auto fit = refine_jointly(flights, 1, {12.8, 20.0}, 13.0);  // the answer is 12.57
    EXPECT_DOUBLE_EQ(fit.theta_rad, 12.8);
}

// What the scan is for: one period is where a plain search would begin.
TEST(JointRefinement, FromOnePeriodTheFasterFrequenciesAreMissed) {
    int missed = 0;
    for (const double periods : {1.0, 1.3, 4.2, 10.0}) {
        std::mt19937 random(1);
        const auto phase = test::cruise_of(periods, {1.5, 2.6, 2.0}, {4.8, 1.2, -1.1});
        const std::vector flights{test::centred(test::record(phase, {600.0, 0.1, 1.5, 0.0}, random))};
        try {
            const auto fit = refine_jointly(flights, 3, wide, 2.0 * std::numbers::pi);
            missed += std::abs(fit.theta_rad / test::theta_rad(phase) - 1.0) > 0.01;
        } catch (const NoAnswerError&) {
            ++missed;
        }
    }
    EXPECT_GE(missed, 2);
}

TEST(JointRefinement, RefusesTimesThatDetermineNothing) {
    ScaledSamples samples;
    for (int i = 0; i < 30; ++i) {
        samples.tau.push_back(0.5 * (i % 3));
        samples.value.push_back(i % 2 == 0 ? 1.0 : -1.0);
    }
    EXPECT_THROW(refine_jointly(std::vector{samples}, 3, wide, 5.0), NoAnswerError);
}

}  // namespace
}  // namespace flightwatt::mechanical
