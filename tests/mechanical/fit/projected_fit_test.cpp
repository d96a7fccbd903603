#include "mechanical/fit/projected_fit.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/least_squares.h"

#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

double square_sum_by_qr(const ScaledSamples& samples, int order, double theta_rad) {
    const auto values = Eigen::Map<const Eigen::VectorXd>(samples.value.data(),
                                                          static_cast<Eigen::Index>(samples.value.size()));
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
