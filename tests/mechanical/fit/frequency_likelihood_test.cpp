#include "mechanical/fit/frequency_likelihood.h"

#include "helpers/interval_coverage.h"
#include "mechanical/fit/frequency_posterior.h"
#include "mechanical/fit/phase_fit.h"

#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

PhaseSamples cruise(double noise_w, double autocorrelation, double duration_s, unsigned seed) {
    std::mt19937 random(seed);
    return test::record(test::published_model().phases[flight::Phase::cruise],
                        {duration_s, 1.1, noise_w, autocorrelation}, random);
}

TEST(OneFrequency, IsToldOnlyWhereAllThatMayBeAreOne) {
    int told = 0;
    int cases = 0;
    for (const double noise_w : {0.05, 0.24, 1.0}) {
        for (const double autocorrelation : {0.0, 0.4, 0.9}) {
            for (unsigned seed = 1; seed <= 3; ++seed) {
                const auto samples = cruise(noise_w, autocorrelation, 600.0, seed);
                const auto fit =
                    fit_phase(flight::Phase::cruise, std::span(&samples, 1), {.curve = CurveEstimator::least_squares});
                const auto values = sort_by_time({samples.tau, samples.power_w, ""});
                ++cases;
                if (!is_frequency_determined(std::span(&values, 1), 3, fit.range, fit.theta_rad)) continue;
                ++told;
                const auto posterior = frequency_posterior(std::span(&values, 1), {3, fit.range, fit.theta_rad});
                const auto [low_rad, high_rad] = frequency_interval(posterior);
                EXPECT_LT(3.0 * (high_rad - low_rad), 1.0) << noise_w << " " << autocorrelation << " " << seed;
            }
        }
    }
    EXPECT_GE(told, 6);
    EXPECT_LT(told, cases);
}

TEST(OneFrequency, IsNotToldOfFewSamplesLastingNoiseOrABound) {
    const auto told = [](const PhaseSamples& samples, double found_rad) {
        const auto values = sort_by_time({samples.tau, samples.power_w, ""});
        return is_frequency_determined(std::span(&values, 1), 3, {3.142, 60.0}, found_rad);
    };
    const auto clear = cruise(0.05, 0.0, 600.0, 1);
    const auto fit = fit_phase(flight::Phase::cruise, std::span(&clear, 1), {.curve = CurveEstimator::least_squares});
    EXPECT_TRUE(told(clear, fit.theta_rad));
    EXPECT_FALSE(told(clear, 3.142)) << "at the bound";
    EXPECT_FALSE(told(clear, 2.0 * fit.theta_rad)) << "where it is not";
    EXPECT_FALSE(told(cruise(0.05, 0.0, 60.0, 1), fit.theta_rad)) << "some fifty samples";
    EXPECT_FALSE(told(cruise(0.05, 0.9, 600.0, 1), fit.theta_rad)) << "noise that lasts";
}

}  // namespace
}  // namespace flightwatt::mechanical
