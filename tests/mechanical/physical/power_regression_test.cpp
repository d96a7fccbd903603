#include "mechanical/physical/power_regression.h"

#include "helpers/generated_motion.h"
#include "mechanical/physical/term_choice.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

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
                data.columns(row, static_cast<Eigen::Index>(i)) =
                    bin.values[terms[i]] / column_scale()[static_cast<int>(terms[i])];
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

}  // namespace
}  // namespace flightwatt::mechanical
