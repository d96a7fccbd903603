#include "mission/sampling/joint_spread.h"

#include "base/statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

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
