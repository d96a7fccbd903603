#include "mechanical/fit/fourier_basis.h"

#include "helpers/made_up_flights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
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

TEST(FourierResidual, IsCurveMinusSamples) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    std::mt19937 random(1);
    const auto samples = test::record(phase, {28.0, 1.1, 0.0, 0.0}, random);
    const auto& f = phase.fourier;
    Eigen::VectorXd coefficients(7);
    coefficients << f.a0_w, f.cos_w[0], f.sin_w[0], f.cos_w[1], f.sin_w[1], f.cos_w[2], f.sin_w[2];
    EXPECT_EQ(coefficients_of(f), coefficients);
    EXPECT_EQ(series_of(coefficients, f.omega_rad_per_s).sin_w, f.sin_w);
    EXPECT_LT(residual_of(samples, test::theta_rad(phase), coefficients).cwiseAbs().maxCoeff(), 1e-12);
}

// NIST Statistical Reference Datasets, linear regression, "Longley" (condition number 5e9; higher
// difficulty): y, x1 .. x6 and the certified values.
constexpr double longley[16][7] = {
    {60323, 83.0, 234289, 2356, 1590, 107608, 1947},  {61122, 88.5, 259426, 2325, 1456, 108632, 1948},
    {60171, 88.2, 258054, 3682, 1616, 109773, 1949},  {61187, 89.5, 284599, 3351, 1650, 110929, 1950},
    {63221, 96.2, 328975, 2099, 3099, 112075, 1951},  {63639, 98.1, 346999, 1932, 3594, 113270, 1952},
    {64989, 99.0, 365385, 1870, 3547, 115094, 1953},  {63761, 100.0, 363112, 3578, 3350, 116219, 1954},
    {66019, 101.2, 397469, 2904, 3048, 117388, 1955}, {67857, 104.6, 419180, 2822, 2857, 118734, 1956},
    {68169, 108.4, 442769, 2936, 2798, 120445, 1957}, {66513, 110.8, 444546, 4681, 2637, 121950, 1958},
    {68655, 112.6, 482704, 3813, 2552, 123366, 1959}, {69564, 114.2, 502601, 3931, 2514, 125368, 1960},
    {69331, 115.7, 518173, 4806, 2572, 127852, 1961}, {70551, 116.9, 554894, 4007, 2827, 130081, 1962}};
constexpr double longley_coefficients[7] = {-3482258.63459582, 15.0618722713733,  -0.358191792925910E-01,
                                            -2.02022980381683, -1.03322686717359, -0.511041056535807E-01,
                                            1829.15146461355};
constexpr double longley_residual_deviation = 304.854073561965;

TEST(LeastSquares, MeetsTheCertifiedValuesOfLongley) {
    Eigen::MatrixXd matrix(16, 7);
    Eigen::VectorXd values(16);
    for (Eigen::Index i = 0; i < 16; ++i) {
        values(i) = longley[i][0];
        matrix(i, 0) = 1.0;
        for (Eigen::Index j = 1; j < 7; ++j) matrix(i, j) = longley[i][j];
    }
    const auto fit = solve_least_squares(matrix, values);
    ASSERT_TRUE(fit);
    for (Eigen::Index j = 0; j < 7; ++j) {
        const double certified = longley_coefficients[j];
        EXPECT_NEAR(fit->coefficients(j), certified, 1e-8 * std::abs(certified)) << "coefficient " << j;
    }
    EXPECT_NEAR(std::sqrt(fit->residual_square_sum / 9.0), longley_residual_deviation, 1e-8);
}

TEST(LeastSquares, IsTheFourierTransformOnAWholePeriod) {
    std::vector<double> tau(50);
    Eigen::VectorXd values(50);
    for (std::size_t i = 0; i < 50; ++i) {
        tau[i] = static_cast<double>(i) / 50.0;
        values(static_cast<Eigen::Index>(i)) = std::exp(std::sin(20.0 * tau[i]));
    }
    const auto basis = fourier_basis(tau, 3, 2.0 * std::numbers::pi);
    const auto fit = solve_least_squares(basis, values);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->coefficients(0), values.mean(), 1e-13);
    for (Eigen::Index j = 1; j < 7; ++j) EXPECT_NEAR(fit->coefficients(j), basis.col(j).dot(values) / 25.0, 1e-13);
}

TEST(LeastSquares, TheCovarianceIsTheInverseOfTheNormalMatrix) {
    const auto basis = fourier_basis(std::vector{0.0, 0.1, 0.15, 0.3, 0.42, 0.6, 0.7, 0.8, 0.95}, 2, 5.0);
    const auto fit = solve_least_squares(basis, Eigen::VectorXd::Ones(basis.rows()));
    ASSERT_TRUE(fit);
    const Eigen::MatrixXd product = fit->covariance * (basis.transpose() * basis);
    EXPECT_LT((product - Eigen::MatrixXd::Identity(5, 5)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LeastSquares, RefusesWhatTheValuesDoNotDetermine) {
    Eigen::MatrixXd matrix(4, 2);
    matrix << 1, 2, 2, 4, 3, 6, 4, 8;
    EXPECT_FALSE(solve_least_squares(matrix, Eigen::VectorXd::Ones(4)));
    EXPECT_FALSE(solve_least_squares(Eigen::MatrixXd::Ones(1, 2), Eigen::VectorXd::Ones(1)));
    EXPECT_FALSE(solve_least_squares(Eigen::MatrixXd::Zero(3, 1), Eigen::VectorXd::Ones(3)));
}

PhaseSamples scattered_samples(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> tau(0.0, 1.0);
    std::normal_distribution<double> value(0.0, 1.0);
    PhaseSamples samples{"", 1.0, {0.0, 1.0}, {0.5, -2.0}};  // both ends of the phase
    for (std::size_t i = 2; i < count; ++i) {
        samples.tau.push_back(tau(random));
        samples.power_w.push_back(value(random));
    }
    return samples;
}

TEST(TrigonometricSums, AreTheSums) {
    const PhaseSamples samples{"", 1.0, {0.0, 0.25, 0.9}, {1.0, -2.0, 0.5}};
    const auto sums = trigonometric_sums(samples, 1.7, 9);
    for (std::size_t m = 0; m < 9; ++m) {
        std::complex<double> weight = 0.0;
        std::complex<double> value = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto turned = std::polar(1.0, static_cast<double>(m) * 1.7 * samples.tau[i]);
            weight += turned;
            value += samples.power_w[i] * turned;
        }
        EXPECT_LT(std::abs(sums.weight[m] - weight), 1e-13);
        EXPECT_LT(std::abs(sums.value[m] - value), 1e-13);
    }
}

TEST(TrigonometricSums, KeepElevenDigitsOverAWholeScan) {
    const auto samples = scattered_samples(300, 7);
    constexpr std::size_t count = 14000;
    const auto sums = trigonometric_sums(samples, 1.0 / 3.0, count);
    for (std::size_t m = 1; m < count; m += 331) {
        std::complex<double> value = 0.0;
        for (std::size_t i = 0; i < samples.tau.size(); ++i)
            value += samples.power_w[i] * std::polar(1.0, static_cast<double>(m) / 3.0 * samples.tau[i]);
        EXPECT_LT(std::abs(sums.value[m] - value) / 300.0, 1e-11) << m;
    }
}

double square_sum_by_qr(const PhaseSamples& samples, int order, double theta_rad) {
    const auto values =
        Eigen::Map<const Eigen::VectorXd>(samples.power_w.data(), static_cast<Eigen::Index>(samples.power_w.size()));
    return solve_least_squares(fourier_basis(samples.tau, order, theta_rad), values)->residual_square_sum;
}

TEST(ProjectedFit, LeavesWhatQrLeaves) {
    std::vector<PhaseSamples> flights;
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
    const auto sums = trigonometric_sums(samples, 0.5, 2 * 3 * 20 + 1);
    for (const std::size_t stride : {std::size_t{7}, std::size_t{13}, std::size_t{20}}) {
        const auto own = trigonometric_sums(samples, 0.5 * static_cast<double>(stride), 7);
        EXPECT_NEAR(explained_square_sum(sums, stride, 3), explained_square_sum(own, 1, 3), 1e-9);
    }
}

TEST(ProjectedFit, CollinearColumnsExplainNothingTwice) {
    // All samples at three times: of seven columns at most three are independent.
    PhaseSamples samples;
    double total = 0.0;
    for (int i = 0; i < 30; ++i) {
        samples.tau.push_back(0.5 * (i % 3));
        samples.power_w.push_back(i % 3 == 0 ? 1.0 : -0.5);
        total += samples.power_w.back() * samples.power_w.back();
    }
    const auto sums = trigonometric_sums(samples, 4.0, 7);
    EXPECT_NEAR(explained_square_sum(sums, 1, 3), total, 1e-6 * total);
}

}  // namespace
}  // namespace flightwatt::mechanical
