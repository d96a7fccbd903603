#include "mechanical/physical/path_prediction.h"

#include "helpers/generated_motion.h"
#include "mechanical/prediction/variance_components.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// What the joint normal distribution of all powers says, with their whole covariance. The drift's covariance with the
/// mean ahead is its integral.
TEST(PathPrediction, IsTheConditionalMeanOfTheJointDistribution) {
    const auto model = test::drag_and_climb_model();
    const auto flown = test::made_up_motions(1, 12, {}, 5).front().bins;
    const double now_s = 360.0;
    const double remaining_s = 400.0;
    const auto ahead = term_values({.airspeed_m_per_s = 14.5, .climb_m_per_s = 0.1});
    const auto count = static_cast<Eigen::Index>(flown.size());
    Eigen::MatrixXd rows(count + 1, 3);  // the last row is what lies ahead
    const auto set_row = [&](Eigen::Index i, const TermValues& values) {
        rows.row(i) << values[PowerTerm::drag], values[PowerTerm::climb], sum_of_terms_w(model, values);
    };
    for (Eigen::Index i = 0; i < count; ++i) set_row(i, flown[static_cast<std::size_t>(i)].values);
    set_row(count, ahead);
    Eigen::Matrix3d prior = Eigen::Matrix3d::Zero();
    prior << 1e-7, 2e-5, 0.0, 2e-5, 0.25, 0.0, 0.0, 0.0, 0.01;
    Eigen::MatrixXd covariance = rows * prior * rows.transpose();
    const double ahead_integral = 60.0 * (1.0 - std::exp(-remaining_s / 60.0)) / remaining_s;
    for (Eigen::Index i = 0; i < count; ++i) {
        const double middle_s = flown[static_cast<std::size_t>(i)].middle_s();
        for (Eigen::Index j = 0; j < count; ++j)
            covariance(i, j) +=
                9.0 * std::exp(-std::abs(middle_s - flown[static_cast<std::size_t>(j)].middle_s()) / 60.0);
        const double with_ahead = 9.0 * std::exp(-(now_s - middle_s) / 60.0) * ahead_integral;
        covariance(i, count) += with_ahead;
        covariance(count, i) += with_ahead;
    }
    covariance(count, count) += variance_of_mean_w2({3.0, 60.0}, remaining_s);
    Eigen::VectorXd residual(count);
    for (Eigen::Index i = 0; i < count; ++i) residual[i] = flown[static_cast<std::size_t>(i)].power_w - rows(i, 2);
    const Eigen::VectorXd gain =
        covariance.topLeftCorner(count, count).ldlt().solve(covariance.topRightCorner(count, 1));
    const double mean_w = rows(count, 2) + gain.dot(residual);
    const double variance_w2 = covariance(count, count) - gain.dot(covariance.topRightCorner(count, 1).col(0));

    const auto power = predict_posterior_power(model, flown, now_s, ahead, remaining_s);
    EXPECT_NEAR(power.mean_w, mean_w, 1e-8 * mean_w);
    EXPECT_NEAR(power.parameter_sd_w * power.parameter_sd_w + power.drift_sd_w * power.drift_sd_w, variance_w2,
                1e-8 * variance_w2);
    EXPECT_DOUBLE_EQ(power.model_w, rows(count, 2));
}

TEST(PathPrediction, IsTheModelBeforeAnythingWasFlown) {
    const auto model = test::drag_and_climb_model();
    const auto ahead = term_values({.airspeed_m_per_s = 14.0});
    const auto power = predict_posterior_power(model, {}, 0.0, ahead, 600.0);
    EXPECT_DOUBLE_EQ(power.mean_w, sum_of_terms_w(model, ahead));
    EXPECT_EQ(power.level, 0.0);
    const auto before = prediction_uncertainty(model, ahead, 600.0).value();
    EXPECT_NEAR(std::hypot(power.parameter_sd_w, power.drift_sd_w), before.sd_w, 1e-9 * before.sd_w);
}

TEST(PathPrediction, LearnsTheFlightsLevel) {
    auto model = test::drag_and_climb_model();
    model.covariance = {{0.0, 0.0}, {0.0, 0.0}};
    auto flown = test::made_up_motions(1, 60, {.level_sd = 0.0, .drift_sd_w = 0.0}, 5).front().bins;
    for (auto& bin : flown) bin.power_w = 1.2 * sum_of_terms_w(model, bin.values);
    const auto power = predict_posterior_power(model, flown, 1800.0, term_values({.airspeed_m_per_s = 14.0}), 600.0);
    EXPECT_GT(power.level, 0.18);
    EXPECT_LT(power.level, 0.2);
    EXPECT_LT(power.parameter_sd_w, 0.1 * power.model_w / 2.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
