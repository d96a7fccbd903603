#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(FourierBasis, HoldsCosinesAndSinesOfMultiples) {
    const std::vector<double> tau{0.0, 0.3, 1.0};
    const auto basis = fourier_basis(tau, 4, 7.5);
    ASSERT_EQ(basis.rows(), 3);
    ASSERT_EQ(basis.cols(), coefficient_count(4));
    for (Eigen::Index i = 0; i < 3; ++i) {
        EXPECT_EQ(basis(i, 0), 1.0);
        for (Eigen::Index n = 1; n <= 4; ++n) {
            const double angle = static_cast<double>(n) * 7.5 * tau[static_cast<std::size_t>(i)];
            EXPECT_NEAR(basis(i, 2 * n - 1), std::cos(angle), 1e-14);
            EXPECT_NEAR(basis(i, 2 * n), std::sin(angle), 1e-14);
        }
    }
}

TEST(FourierBasis, IsOrthogonalOverWholePeriodsAndCollinearBelowOne) {
    EXPECT_NEAR(basis_condition(3, 2.0 * std::numbers::pi), 1.0, 1e-9);
    EXPECT_NEAR(basis_condition(3, 6.0 * std::numbers::pi), 1.0, 1e-9);
    // The figures that the default of the lowest frequency rests on.
    EXPECT_NEAR(basis_condition(3, 3.63), 38.0, 1.0);
    EXPECT_NEAR(basis_condition(3, std::numbers::pi), 108.0, 1.0);
    EXPECT_GT(basis_condition(3, 2.0), 2000.0);
    EXPECT_GT(basis_condition(3, 1.0), 200000.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
