#include "mechanical/fit/projected_fit.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
        for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{100}, std::size_t{5000}}) {
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

double square_sum_by_qr(const ScaledSamples& samples, int order, double theta_rad) {
    const auto values =
        Eigen::Map<const Eigen::VectorXd>(samples.value.data(), static_cast<Eigen::Index>(samples.value.size()));
    return solve_least_squares(fourier_basis(samples.tau, order, theta_rad), values)->residual_square_sum;
}

TEST(ProjectedFit, LeavesWhatQrLeaves) {
    std::vector<ScaledSamples> flights;
    for (const auto& samples : test::record_flights(flight::Phase::cruise, 3, 0.5, 1))
        flights.push_back(test::centred(samples));
    for (int order = 1; order <= 5; ++order) {
        for (const double theta_rad : {std::numbers::pi, 4.0, 6.3, 20.0, 80.0}) {
            double expected = 0.0;
            for (const auto& flight : flights) expected += square_sum_by_qr(flight, order, theta_rad);
            EXPECT_NEAR(projected_square_sum(flights, order, theta_rad), expected, 1e-8 * expected)
                << "order " << order << ", theta " << theta_rad;
        }
    }
}

TEST(ProjectedFit, AStrideIsAMultipleOfTheStep) {
    const auto samples = test::centred(test::record_flights(flight::Phase::landing, 1, 0.1, 2).front());
    const auto sums = sum_directly(samples, 0.5, 2 * 3 * 20 + 1);
    for (const std::size_t stride : {std::size_t{7}, std::size_t{13}, std::size_t{20}}) {
        const auto own = sum_directly(samples, 0.5 * static_cast<double>(stride), 7);
        EXPECT_NEAR(explained_square_sum(sums, stride, 3), explained_square_sum(own, 1, 3), 1e-9);
    }
}

TEST(ProjectedFit, CollinearColumnsExplainNothingTwice) {
    // All samples at three times: of seven columns at most three are independent.
    ScaledSamples samples;
    double total = 0.0;
    for (int i = 0; i < 30; ++i) {
        samples.tau.push_back(0.5 * (i % 3));
        samples.value.push_back(i % 3 == 0 ? 1.0 : -0.5);
        total += samples.value.back() * samples.value.back();
    }
    const auto sums = sum_directly(samples, 4.0, 7);
    EXPECT_NEAR(explained_square_sum(sums, 1, 3), total, 1e-6 * total);
}

}  // namespace
}  // namespace flightwatt::mechanical
