#include "mechanical/fit/trigonometric_sums.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

ScaledSamples scattered_samples(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> tau(0.0, 1.0);
    std::normal_distribution<double> value(0.0, 1.0);
    ScaledSamples samples{{0.0, 1.0}, {0.5, -2.0}};  // both ends of the phase
    for (std::size_t i = 2; i < count; ++i) {
        samples.tau.push_back(tau(random));
        samples.value.push_back(value(random));
    }
    return samples;
}

TEST(TrigonometricSums, DirectSumsAreTheSums) {
    const ScaledSamples samples{{0.0, 0.25, 0.9}, {1.0, -2.0, 0.5}};
    const auto sums = sum_directly(samples, 1.7, 9);
    for (std::size_t m = 0; m < 9; ++m) {
        std::complex<double> weight = 0.0;
        std::complex<double> value = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto turned = std::polar(1.0, static_cast<double>(m) * 1.7 * samples.tau[i]);
            weight += turned;
            value += samples.value[i] * turned;
        }
        EXPECT_LT(std::abs(sums.weight[m] - weight), 1e-13);
        EXPECT_LT(std::abs(sums.value[m] - value), 1e-13);
    }
}

TEST(TrigonometricSums, FftSumsAreTheDirectSums) {
    for (const double step_rad : {0.05, 1.0 / 3.0, 1.0, 9.0}) {
        for (const std::size_t count :
             {std::size_t{1}, std::size_t{7}, std::size_t{100}, std::size_t{5000}}) {
            const auto samples = scattered_samples(300, 7);
            const auto direct = sum_directly(samples, step_rad, count);
            const auto fast = sum_by_fft(samples, step_rad, count);
            ASSERT_EQ(fast.weight.size(), count);
            double worst = 0.0;
            for (std::size_t m = 0; m < count; ++m) {
                worst = std::max(worst, std::abs(fast.weight[m] - direct.weight[m]));
                worst = std::max(worst, std::abs(fast.value[m] - direct.value[m]));
            }
            EXPECT_LT(worst / 300.0, 1e-11) << "step " << step_rad << ", " << count << " sums";
        }
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
