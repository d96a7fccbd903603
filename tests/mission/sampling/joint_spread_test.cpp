#include "mission/sampling/joint_spread.h"

#include "base/statistics.h"
#include "mission/sampling/flight_spreads.h"

#include <cmath>
#include <random>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

double student_t_beyond(double value, double degrees_of_freedom) {
    return cdf(complement(boost::math::students_t(degrees_of_freedom), value));
}

TEST(Student, LiesAsFarOutAsTheNormal) {
    for (const double freedom : {1.0, 2.0, 3.5, 10.0})
        EXPECT_NEAR(student_from_normal(normal_half_width(), freedom), student_t_half_width(freedom), 1e-9) << freedom;
    EXPECT_NEAR(student_from_normal(normal_quantile(0.95), 1.0), std::tan(0.45 * std::acos(-1.0)), 1e-9);
    EXPECT_EQ(student_from_normal(1.3, infinite_dof), 1.3);
    EXPECT_EQ(student_from_normal(0.0, 2.0), 0.0);
    EXPECT_EQ(student_from_normal(-1.3, 2.0), -student_from_normal(1.3, 2.0));
}

TEST(Student, OfTablesIsThatOfTheDistribution) {
    for (const double freedom : {1.0, 2.0, 3.5, 30.0, 1000.0})
        for (double normal = 0.003; normal < 8.5; normal += 0.0517) {
            const double beyond = cdf(complement(boost::math::normal(), normal));
            const double exact = std::min(max_student, quantile(complement(boost::math::students_t(freedom), beyond)));
            EXPECT_NEAR(student_from_normal(normal, freedom) / exact, 1.0, 1e-9) << freedom << ", " << normal;
        }
}

TEST(Student, EndsSomewhere) {
    EXPECT_EQ(student_from_normal(9.0, 1.0), max_student);
    EXPECT_EQ(student_from_normal(-40.0, 1.0), -max_student);
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

/// Flights of a normal distribution, whose mean and deviation are estimated from a few of them. Student's t puts a
/// greater part beyond a far threshold than new flights have: 6 % for 0.7 % of two flights, on average. The interval
/// contains the true part nevertheless.
TEST(Student, IntervalOfAShareContainsThatOfNewFlights) {
    constexpr int models = 200;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const int flights : {2, 3, 6}) {
        for (const double threshold : {1.0, 2.457}) {
            const double true_share = 0.5 * std::erfc(threshold / std::sqrt(2.0));
            int held = 0;
            double drawn_sum = 0.0;
            for (int i = 0; i < models; ++i) {
                std::vector<double> flown(static_cast<std::size_t>(flights));
                for (double& value : flown) value = normal(random);
                const double off = (threshold - mean(flown)) / (sample_sd(flown) * std::sqrt(1.0 + 1.0 / flights));
                const double drawn = student_t_beyond(off, flights - 1.0);
                drawn_sum += drawn;
                const auto interval = interval_of_share({drawn, drawn}, flights - 1.0);
                held += interval.low <= true_share && true_share <= interval.high;
            }
            EXPECT_NEAR(held / static_cast<double>(models), 0.95, 0.05) << flights << " flights, " << threshold;
            EXPECT_GT(drawn_sum / models, true_share) << "the heavy tail";
        }
    }
}

TEST(Student, IntervalOfAShareIsThatOfTheDrawnFlightsWhereTheSpreadIsKnown) {
    const Interval drawn{0.01, 0.03};
    EXPECT_EQ(interval_of_share(drawn, infinite_dof), drawn);
    const auto of_many = interval_of_share(drawn, 1e4);
    EXPECT_NEAR(of_many.low, drawn.low, 0.001);
    EXPECT_NEAR(of_many.high, drawn.high, 0.003);
    EXPECT_EQ(interval_of_share({0.0, 1.0}, 1.0), (Interval{0.0, 1.0}));
}

using Values = std::vector<std::optional<double>>;

Eigen::MatrixXd covariance_of(const JointDistribution& joint) { return joint.factor * joint.factor.transpose(); }

TEST(JointSpread, HasTheVarianceThatItsFlightsShowOfAnySum) {
    const Values takeoff{{50.0, 52.0, 47.0, 49.0}};
    const Values cruise{{25.0, 26.5, 24.0, 26.0}};
    std::vector<double> first;
    std::vector<double> second;
    std::vector<double> sum;
    for (std::size_t i = 0; i < takeoff.size(); ++i) {
        first.push_back(*takeoff[i]);
        second.push_back(*cruise[i]);
        sum.push_back(3.0 * *takeoff[i] + 60.0 * *cruise[i]);
    }
    const auto joints =
        estimate_joint_distributions({{0, sample_sd(first), 3.0, takeoff}, {2, sample_sd(second), 3.0, cruise}});
    ASSERT_EQ(joints.size(), 1U);
    EXPECT_EQ(joints[0].quantities, (std::vector<std::size_t>{0, 2}));
    const Eigen::Vector2d weights(3.0, 60.0);
    EXPECT_NEAR(weights.dot(covariance_of(joints[0]) * weights), sample_variance(sum), 1e-9);
}

TEST(JointSpread, GoesStrictlyTogetherInTwoFlights) {
    const auto joints = estimate_joint_distributions({{0, 1.0, 1.0, {1.0, 2.0}}, {1, 3.0, 1.0, {9.0, 4.0}}});
    ASSERT_EQ(joints.size(), 1U);
    EXPECT_NEAR(covariance_of(joints[0])(0, 1), -3.0, 1e-12);
}

TEST(JointSpread, KnowsNoCorrelationWithoutFlights) {
    const Values unknown(3);
    const auto joints =
        estimate_joint_distributions({{0, 2.0, 2.0, unknown}, {1, 1.0, 2.0, {4.0, 5.0, 7.0}}, {2, 5.0, 2.0, {}}});
    ASSERT_EQ(joints.size(), 1U);
    const Eigen::Vector3d variances(4.0, 1.0, 25.0);
    EXPECT_TRUE(covariance_of(joints[0]).isApprox(Eigen::MatrixXd(variances.asDiagonal())));
}

TEST(JointSpread, TakesTheFlightsThatHaveAll) {
    const auto joints =
        estimate_joint_distributions({{0, 1.0, 2.0, {1.0, 2.0, 4.0, {}}}, {2, 1.0, 2.0, {{}, 5.0, 6.0, 9.0}}});
    ASSERT_EQ(joints.size(), 1U);
    EXPECT_NEAR(covariance_of(joints[0])(0, 1), 1.0, 1e-12) << "two flights have both";
}

TEST(JointSpread, KeepsApartWhatRestsOnOtherNumbersOfFlights) {
    const auto joints = estimate_joint_distributions(
        {{0, 1.0, 1.0, {1.0, 2.0, {}}}, {2, 1.0, 2.0, {1.0, 2.0, 3.0}}, {4, 0.0, 2.0, {3.0, 3.0, 3.0}}});
    ASSERT_EQ(joints.size(), 2U);
    EXPECT_EQ(joints[0].degrees_of_freedom, 1.0);
    EXPECT_EQ(joints[1].quantities, (std::vector<std::size_t>{2})) << "what does not differ is not drawn";
}

}  // namespace
}  // namespace flightwatt::mission
