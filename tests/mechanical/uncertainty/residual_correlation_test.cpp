#include "mechanical/uncertainty/residual_correlation.h"

#include <cmath>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

const std::vector<double> with_gaps{0.0, 0.1, 0.2, 0.5, 0.55, 0.9, 1.0};

/// The correlation matrix, entry by entry.
Eigen::MatrixXd full_matrix(const std::vector<double>& tau, double step, double autocorrelation) {
    const auto count = static_cast<Eigen::Index>(tau.size());
    Eigen::MatrixXd matrix(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j < count; ++j) {
            const double gap = std::abs(tau[static_cast<std::size_t>(i)] - tau[static_cast<std::size_t>(j)]);
            matrix(i, j) = std::pow(autocorrelation, gap / step);
        }
    }
    return matrix;
}

TEST(ResidualCorrelation, EffectiveSamplesAreThoseOfTheWholeMatrix) {
    const auto correlation = sample_correlation(with_gaps, 0.1, 0.6);
    EXPECT_NEAR(effective_samples(correlation), 49.0 / full_matrix(with_gaps, 0.1, 0.6).sum(), 1e-12);
}

TEST(ResidualCorrelation, EffectiveSamplesAreThoseOfTheTextbookWithoutGaps) {
    std::vector<double> tau;
    for (int i = 0; i < 20000; ++i) tau.push_back(i / 20000.0);
    EXPECT_NEAR(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.5)), 20000.0 / 3.0, 2.0);
    EXPECT_DOUBLE_EQ(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.0)), 20000.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
