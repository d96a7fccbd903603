#include "mechanical/physical/power_regression.h"

#include "helpers/generated_motion.h"

#include <cmath>
#include <span>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

PosteriorPower posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown, double now_s,
                               const MotionAhead& ahead) {
    return predict_posterior_power(model, flown, now_s, {&ahead, 1}).front();
}

/// The same fit with the whole covariance matrix of all bins.
struct DenseFit {
    Eigen::VectorXd coefficients;
    double drift_variance_w2 = 0.0;
    double log_likelihood = 0.0;
};

struct DenseData {
    Eigen::MatrixXd columns;
    Eigen::VectorXd power_w;
    std::vector<Eigen::Index> starts;  ///< of the flights, and the end
};

DenseData dense_data(const std::vector<BinnedFlight>& flights, const std::vector<PowerTerm>& terms) {
    Eigen::Index rows = 0;
    for (const auto& flight : flights) rows += static_cast<Eigen::Index>(flight.bins.size());
    DenseData data{Eigen::MatrixXd(rows, static_cast<Eigen::Index>(terms.size())), Eigen::VectorXd(rows), {0}};
    Eigen::Index row = 0;
    for (const auto& flight : flights) {
        for (const auto& bin : flight.bins) {
            for (std::size_t i = 0; i < terms.size(); ++i)
                data.columns(row, static_cast<Eigen::Index>(i)) = bin.values[terms[i]];
            data.power_w[row++] = bin.power_w;
        }
        data.starts.push_back(row);
    }
    return data;
}

/// R + (level_sd^2 / drift variance) m m', block by block.
Eigen::MatrixXd dense_covariance(const std::vector<BinnedFlight>& flights, const DenseData& data,
                                 const Eigen::VectorXd& expected, double correlation_s, double ratio) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(data.power_w.size(), data.power_w.size());
    for (std::size_t f = 0; f < flights.size(); ++f) {
        const auto& bins = flights[f].bins;
        for (std::size_t i = 0; i < bins.size(); ++i) {
            for (std::size_t j = 0; j < bins.size(); ++j) {
                const auto row = data.starts[f] + static_cast<Eigen::Index>(i);
                const auto column = data.starts[f] + static_cast<Eigen::Index>(j);
                const double lag_s = std::abs(bins[i].middle_s() - bins[j].middle_s());
                covariance(row, column) = std::exp(-lag_s / correlation_s) + ratio * expected[row] * expected[column];
            }
        }
    }
    return covariance;
}

DenseFit dense_fit(const std::vector<BinnedFlight>& flights, const std::vector<PowerTerm>& terms,
                   VarianceGridPoint node) {
    const auto data = dense_data(flights, terms);
    const auto freedom = static_cast<double>(data.columns.rows() - data.columns.cols());
    DenseFit fit;
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(data.power_w.size());
    for (int round = 0; round < 6; ++round) {
        const double ratio = round == 0 ? 0.0 : node.level_sd * node.level_sd / fit.drift_variance_w2;
        const auto covariance = dense_covariance(flights, data, expected, node.correlation_s, ratio);
        const Eigen::LDLT<Eigen::MatrixXd> factor(covariance);
        const Eigen::MatrixXd weighted = factor.solve(data.columns);
        const Eigen::MatrixXd normal = data.columns.transpose() * weighted;
        fit.coefficients = normal.ldlt().solve(weighted.transpose() * data.power_w);
        const Eigen::VectorXd residual = data.power_w - data.columns * fit.coefficients;
        fit.drift_variance_w2 = residual.dot(factor.solve(residual)) / freedom;
        fit.log_likelihood = -0.5 * (freedom * std::log(fit.drift_variance_w2) + factor.vectorD().array().log().sum() +
                                     std::log(normal.determinant()));
        expected = data.columns * fit.coefficients;
    }
    return fit;
}

TEST(PowerRegression, IsGeneralisedLeastSquaresWithTheWholeCovariance) {
    auto flights = test::made_up_motions(3, 25, {}, 7);
    auto& gap = flights[1].bins;
    gap.erase(gap.begin() + 5, gap.begin() + 9);
    const std::vector terms{PowerTerm::drag, PowerTerm::climb, PowerTerm::descent};
    for (const VarianceGridPoint node :
         {VarianceGridPoint{60.0, 0.0}, VarianceGridPoint{60.0, 0.05}, VarianceGridPoint{300.0, 0.3}}) {
        std::vector<NormalEquations> sums;
        for (const auto& flight : flights) sums.push_back(accumulate_normal_equations(flight.bins, node.correlation_s));
        const auto fit = fit_gls(sums, columns_of(terms), node.level_sd).value();
        const auto dense = dense_fit(flights, terms, node);
        for (Eigen::Index i = 0; i < fit.coefficients.size(); ++i)
            EXPECT_NEAR(fit.coefficients[i], dense.coefficients[i], 1e-8 * std::abs(dense.coefficients[i]));
        EXPECT_NEAR(fit.drift_variance_w2, dense.drift_variance_w2, 1e-8 * dense.drift_variance_w2);
        EXPECT_NEAR(fit.log_likelihood, dense.log_likelihood, 1e-7 * std::abs(dense.log_likelihood));
    }
}

TEST(PowerRegression, FindsTheDriftAndTheSpreadOfManyFlights) {
    const auto flights =
        test::made_up_motions(40, 40, {.level_sd = 0.08, .drift_sd_w = 2.0, .correlation_s = 120.0}, 3);
    const auto posterior =
        PowerRegression(flights).posterior(columns_of({PowerTerm::drag, PowerTerm::climb, PowerTerm::descent}));
    ASSERT_TRUE(posterior.has_value());
    const auto& likeliest = posterior->nodes[posterior->likeliest];
    EXPECT_NEAR(likeliest.correlation_s, 120.0, 45.0);
    EXPECT_NEAR(likeliest.level_sd, 0.08, 0.03);
    EXPECT_NEAR(std::sqrt(posterior->fits[posterior->likeliest].drift_variance_w2), 2.0, 0.3);
    double sum = 0.0;
    for (const double weight : posterior->weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(PowerRegression, RefusesColumnsThatAreNotDetermined) {
    auto flights = test::made_up_motions(2, 20, {}, 1);
    for (auto& flight : flights)
        for (auto& bin : flight.bins) bin.values[PowerTerm::climb] = 0.0;
    EXPECT_FALSE(PowerRegression(flights).posterior(columns_of({PowerTerm::drag, PowerTerm::climb})).has_value());
    for (auto& flight : flights)
        for (auto& bin : flight.bins) bin.values[PowerTerm::drag] = 2000.0;
    EXPECT_FALSE(PowerRegression(flights).posterior(columns_of({PowerTerm::drag, PowerTerm::constant})).has_value());
    EXPECT_TRUE(PowerRegression(flights).posterior(columns_of({PowerTerm::constant})).has_value());
}

/// What the joint normal distribution of all powers states, with their whole covariance. The drift's covariance with the
/// mean ahead is its integral.
TEST(PathPrediction, IsTheConditionalMeanOfTheJointDistribution) {
    const auto model = test::drag_and_climb_model();
    const auto flown = test::made_up_motions(1, 12, {}, 5).front().bins;
    const double now_s = 360.0;
    const double remaining_s = 400.0;
    const auto ahead = term_values({.airspeed_m_per_s = 14.5, .climb_m_per_s = 0.1});
    const auto count = static_cast<Eigen::Index>(flown.size());
    Eigen::MatrixXd rows(count + 1, 3);  // the last row is what is ahead
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

    const auto power = posterior_power(model, flown, now_s, {ahead, remaining_s});
    EXPECT_NEAR(power.mean_w, mean_w, 1e-8 * mean_w);
    EXPECT_NEAR(power.parameter_sd_w * power.parameter_sd_w + power.drift_sd_w * power.drift_sd_w, variance_w2,
                1e-8 * variance_w2);
    EXPECT_DOUBLE_EQ(power.model_w, rows(count, 2));
}

TEST(PathPrediction, IsTheModelBeforeAnythingWasFlown) {
    const auto model = test::drag_and_climb_model();
    const auto ahead = term_values({.airspeed_m_per_s = 14.0});
    const auto power = posterior_power(model, {}, 0.0, {ahead, 600.0});
    EXPECT_DOUBLE_EQ(power.mean_w, sum_of_terms_w(model, ahead));
    EXPECT_EQ(power.level, 0.0);
    const double before_w = predicted_power(model, ahead, 600.0).sd_w.value();
    EXPECT_NEAR(std::hypot(power.parameter_sd_w, power.drift_sd_w), before_w, 1e-9 * before_w);
}

TEST(PathPrediction, LearnsTheFlightsLevel) {
    auto model = test::drag_and_climb_model();
    model.covariance = {{0.0, 0.0}, {0.0, 0.0}};
    auto flown = test::made_up_motions(1, 60, {.level_sd = 0.0, .drift_sd_w = 0.0}, 5).front().bins;
    for (auto& bin : flown) bin.power_w = 1.2 * sum_of_terms_w(model, bin.values);
    const auto power = posterior_power(model, flown, 1800.0, {term_values({.airspeed_m_per_s = 14.0}), 600.0});
    EXPECT_GT(power.level, 0.18);
    EXPECT_LT(power.level, 0.2);
    EXPECT_LT(power.parameter_sd_w, 0.1 * power.model_w / 2.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
