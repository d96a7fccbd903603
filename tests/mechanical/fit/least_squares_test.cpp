#include "mechanical/fit/least_squares.h"

#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

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
    for (Eigen::Index j = 1; j < 7; ++j)
        EXPECT_NEAR(fit->coefficients(j), basis.col(j).dot(values) / 25.0, 1e-13);
}

TEST(LeastSquares, TheOrthonormalBasisIsOrthonormalAndSpansTheSame) {
    std::vector<double> tau(80);
    for (std::size_t i = 0; i < tau.size(); ++i) tau[i] = static_cast<double>(i * i) / 6400.0;
    const auto basis = fourier_basis(tau, 3, 3.2);  // collinear enough to tell
    const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(80, -1.0, 2.0).array().cube();
    const auto fit = solve_least_squares(basis, values);
    ASSERT_TRUE(fit);
    const Eigen::MatrixXd orthonormal = basis * fit->from_orthonormal;
    EXPECT_LT((orthonormal.transpose() * orthonormal - Eigen::MatrixXd::Identity(7, 7)).cwiseAbs().maxCoeff(),
              1e-11);
    EXPECT_LT((fit->from_orthonormal * fit->orthonormal - fit->coefficients).cwiseAbs().maxCoeff(),
              1e-11 * fit->coefficients.cwiseAbs().maxCoeff());
}

TEST(LeastSquares, RefusesWhatTheValuesDoNotDetermine) {
    Eigen::MatrixXd matrix(4, 2);
    matrix << 1, 2, 2, 4, 3, 6, 4, 8;
    EXPECT_FALSE(solve_least_squares(matrix, Eigen::VectorXd::Ones(4)));
    EXPECT_FALSE(solve_least_squares(Eigen::MatrixXd::Ones(1, 2), Eigen::VectorXd::Ones(1)));
    EXPECT_FALSE(solve_least_squares(Eigen::MatrixXd::Zero(3, 1), Eigen::VectorXd::Ones(3)));
}

}  // namespace
}  // namespace flightwatt::mechanical
