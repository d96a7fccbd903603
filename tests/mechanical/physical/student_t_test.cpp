#include "mechanical/physical/student_t.h"

#include "base/statistics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(StudentTFit, OfOneNormalIsNearlyNormal) {
    const std::vector<double> sds{0.1};
    const std::vector<double> weights{1.0};
    const auto t = fit_student_t(sds, weights);
    EXPECT_NEAR(t.scale * student_t_half_width(t.degrees_of_freedom), 0.196, 0.001);
    EXPECT_GT(t.degrees_of_freedom, 100.0);
}

/// A Student's t is a mixture of normals: sd = 1 / sqrt(chi^2 / v), here at the quantiles of chi^2 with 4 degrees of
/// freedom by its closed form P(chi^2 > x) = exp(-x/2) (1 + x/2).
TEST(StudentTFit, FindsAStudentTAgain) {
    std::vector<double> sds;
    std::vector<double> weights;
    constexpr int parts = 4000;
    for (int i = 0; i < parts; ++i) {
        const double above = (i + 0.5) / parts;
        double low = 0.0;
        double high = 100.0;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (low + high);
            (std::exp(-middle / 2.0) * (1.0 + middle / 2.0) > above ? low : high) = middle;
        }
        sds.push_back(0.3 * std::sqrt(4.0 / low));
        weights.push_back(1.0 / parts);
    }
    const auto t = fit_student_t(sds, weights);
    EXPECT_NEAR(t.degrees_of_freedom, 4.0, 0.1);
    EXPECT_NEAR(t.scale, 0.3, 0.003);
}

TEST(StudentTFit, OfNothingIsNothing) {
    const std::vector<double> sds{0.0};
    const std::vector<double> weights{1.0};
    EXPECT_EQ(fit_student_t(sds, weights).scale, 0.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
