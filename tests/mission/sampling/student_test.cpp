#include "mission/sampling/student.h"

#include "base/statistics.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(Student, LiesAsFarOutAsTheNormal) {
    for (const double freedom : {1.0, 2.0, 3.5, 10.0})
        EXPECT_NEAR(student_from_normal(normal_half_width(), freedom), student_t_half_width(freedom), 1e-9) << freedom;
    EXPECT_NEAR(student_from_normal(normal_quantile(0.95), 1.0), std::tan(0.45 * std::acos(-1.0)), 1e-9);
    EXPECT_EQ(student_from_normal(1.3, infinite_dof), 1.3);
    EXPECT_EQ(student_from_normal(0.0, 2.0), 0.0);
    EXPECT_EQ(student_from_normal(-1.3, 2.0), -student_from_normal(1.3, 2.0));
}

TEST(Student, ComesBack) {
    for (const double freedom : {1.0, 2.0, 7.3, 200.0})
        for (const double normal : {-3.0, -0.2, 0.0, 1e-3, 1.0, 4.0})
            EXPECT_NEAR(normal_from_student(student_from_normal(normal, freedom), freedom), normal, 1e-9);
    EXPECT_EQ(normal_from_student(2.5, infinite_dof), 2.5);
}

TEST(Student, EndsSomewhere) {
    EXPECT_EQ(student_from_normal(9.0, 1.0), max_student);
    EXPECT_EQ(student_from_normal(-40.0, 1.0), -max_student);
    EXPECT_TRUE(std::isfinite(normal_from_student(1e200, 1.0)));
}

/// A sum of numbers that share one estimated deviation is Student t with the same degrees of freedom, whatever its
/// weights; of independent ones it would not be (with 1 degree it would be wider by sqrt(2) here).
TEST(Student, HasSumsOfItsOwnKind) {
    constexpr double freedom = 2.0;
    constexpr int draws = 40000;
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    for (const double angle : {0.0, 0.6, 1.2, 1.57}) {
        int beyond = 0;
        int both = 0;
        for (int i = 0; i < draws; ++i) {
            const std::vector<double> normals{normal(random), normal(random), normal(random)};
            const auto t = student_vector(normals, freedom);
            beyond += std::abs(std::cos(angle) * t[0] + std::sin(angle) * t[2]) > student_t_half_width(freedom);
            both += std::abs(t[0]) > student_t_half_width(freedom) && std::abs(t[2]) > student_t_half_width(freedom);
        }
        EXPECT_NEAR(beyond / static_cast<double>(draws), 0.05, 0.005) << angle;
        EXPECT_GT(both / static_cast<double>(draws), 0.01) << "independent ones: 0.0025";
    }
}

}  // namespace
}  // namespace flightwatt::mission
