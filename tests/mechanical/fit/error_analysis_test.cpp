
#include "mechanical/fit/error_analysis.h"

#include "helpers/interval_coverage.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

struct Analysed {
    std::vector<PhaseSamples> flights;
    PhaseFit fit;
    std::vector<double> weights;
    ErrorAnalysis analysis;
};

Analysed analysed(std::vector<PhaseSamples> flights, flight::Phase phase, const PhaseFitOptions& options = {}) {
    Analysed result;
    result.fit = fit_phase(phase, flights, options);
    result.weights = flight_weights(result.fit, Weighting::uniform);
    result.analysis = analyse_errors(flights, result.fit, result.weights);
    result.flights = std::move(flights);
    return result;
}

TEST(ErrorAnalysis, OfPreciseSamplesIsTheCovarianceOfTheTextbook) {
    // Little noise: the curve is linear in all that is not known, and sigma^2 (J^T J)^-1 is right.
    const auto one = analysed(test::record_flights(flight::Phase::cruise, 1, 0.05, 1), flight::Phase::cruise);
    const auto& samples = one.flights[0];
    const auto coefficients = coefficients_of(one.fit.flights[0].fourier);
    constexpr double step_rad = 1e-5;
    const auto residual = [&](double off_rad) {
        return residual_of(samples, one.fit.theta_rad + off_rad, coefficients);
    };
    Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(samples.tau.size()), 1 + coefficients.size());
    jacobian << (residual(step_rad) - residual(-step_rad)) / (2.0 * step_rad),
        fourier_basis(samples.tau, 3, one.fit.theta_rad);
    const auto freedom = static_cast<double>(jacobian.rows() - jacobian.cols());
    const Eigen::MatrixXd covariance =
        residual(0.0).squaredNorm() / freedom * (jacobian.transpose() * jacobian).inverse();
    const auto& errors = one.analysis.errors;
    const double wider = std::sqrt((1.0 + errors.autocorrelation) / (1.0 - errors.autocorrelation));
    EXPECT_NEAR(errors.omega_rad_per_s * samples.duration_s, wider * std::sqrt(covariance(0, 0)),
                0.15 * std::sqrt(covariance(0, 0)));
    EXPECT_NEAR(errors.a0_w, wider * std::sqrt(covariance(1, 1)), 0.15 * std::sqrt(covariance(1, 1)));
    EXPECT_NEAR(errors.degrees_of_freedom, (static_cast<double>(one.fit.samples) - 7.0) / (wider * wider), 1e-6);
}

TEST(ErrorAnalysis, BecomeSmallWithTheNoise) {
    for (const auto phase : flight::all_phases) {
        double before = 1e9;
        for (const double noise_w : {1.0, 0.3, 0.1}) {
            const auto found = analysed(test::record_flights(phase, 2, noise_w, 3), phase);
            EXPECT_LT(found.analysis.errors.curve_w, before) << to_string(phase) << " " << noise_w;
            before = found.analysis.errors.curve_w;
        }
    }
}

TEST(ErrorAnalysis, FourFlightsTellTwiceAsWellAsOne) {
    const auto one = analysed(test::record_flights(flight::Phase::cruise, 1, 0.3, 4), flight::Phase::cruise);
    const auto four = analysed(test::record_flights(flight::Phase::cruise, 4, 0.3, 4), flight::Phase::cruise);
    EXPECT_NEAR(four.analysis.errors.curve_w / one.analysis.errors.curve_w, 0.5, 0.12);
    EXPECT_NEAR(four.analysis.errors.omega_rad_per_s / one.analysis.errors.omega_rad_per_s, 0.5, 0.12);
}

TEST(ErrorAnalysis, TheNoiseOfOneFlightCountsByItsWeight) {
    auto two = analysed(test::record_flights(flight::Phase::cruise, 2, 0.3, 5), flight::Phase::cruise);
    const auto only_first = analyse_errors(two.flights, two.fit, std::vector{1.0, 0.0});
    const auto alone = analysed({two.flights[0]}, flight::Phase::cruise);
    EXPECT_NEAR(only_first.errors.curve_w, alone.analysis.errors.curve_w, 0.1 * alone.analysis.errors.curve_w);
    EXPECT_GT(only_first.errors.curve_w, 1.2 * two.analysis.errors.curve_w);
}

TEST(ErrorAnalysis, GoodnessOfFit) {
    const auto exact = analysed(test::record_flights(flight::Phase::cruise, 2, 0.0, 6), flight::Phase::cruise);
    EXPECT_NEAR(exact.analysis.errors.r2, 1.0, 1e-12);
    EXPECT_LT(exact.analysis.errors.curve_w, 1e-5);
    const auto landing = analysed(test::record_flights(flight::Phase::landing, 2, 0.1, 6), flight::Phase::landing);
    EXPECT_GT(landing.analysis.errors.r2, 0.9);
}

TEST(ErrorAnalysis, ConstantPowerHasNoFrequencyToBeSureOf) {
    PhaseSamples samples{"flight", 60.0, {}, {}};
    for (int i = 0; i < 50; ++i) {
        samples.tau.push_back((i + 0.5) / 50.0);
        samples.power_w.push_back(21.7);
    }
    const auto constant = analysed({samples}, flight::Phase::cruise);
    EXPECT_TRUE(constant.analysis.errors.frequency_is_fixed);
    EXPECT_LT(constant.analysis.errors.a0_w, 1e-9);
}

TEST(ErrorAnalysis, OrderZeroIsTheErrorOfTheMean) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(1.0, {}, {});
    const auto samples = test::record(phase, {600.0, 1.0, 0.5, 0.0}, random);
    const auto constant = analysed({samples}, flight::Phase::cruise, {.order = 0});
    EXPECT_NEAR(constant.fit.flights[0].fourier.a0_w, 27.22, 0.1);
    EXPECT_NEAR(constant.analysis.errors.a0_w, 0.5 / std::sqrt(600.0), 0.006);
    EXPECT_TRUE(constant.analysis.errors.frequency_is_fixed);
}

TEST(ErrorAnalysis, RivalFrequenciesWidenTheIntervals) {
    const auto precise = analysed(test::record_flights(flight::Phase::landing, 4, 0.01, 2), flight::Phase::landing);
    const auto noisy = analysed(test::record_flights(flight::Phase::landing, 1, 1.0, 2), flight::Phase::landing);
    ASSERT_TRUE(precise.fit.rivals_rad.empty());
    ASSERT_FALSE(noisy.fit.rivals_rad.empty());
    auto without = noisy.fit;
    without.rivals_rad.clear();
    const auto narrow = analyse_errors(noisy.flights, without, noisy.weights).errors;
    EXPECT_GT(noisy.analysis.errors.curve_w, 1.1 * narrow.curve_w);
}

/// White noise, and such as lasts (autocorrelation 0.7 at 1.1 s).
TEST(ErrorAnalysis, KnowsNoiseThatLasts) {
    auto flights = test::record_flights(flight::Phase::cruise, 2, 0.0, 7);
    auto lasting = flights;
    std::mt19937 random(7);
    for (auto& samples : flights) test::add_noise(samples, 0.3, 0.0, random);
    for (auto& samples : lasting) test::add_noise(samples, 0.3, 0.7, random);
    const auto white = analysed(flights, flight::Phase::cruise).analysis.errors;
    const auto correlated = analysed(lasting, flight::Phase::cruise).analysis.errors;
    EXPECT_LT(white.autocorrelation, 0.1);
    EXPECT_NEAR(correlated.autocorrelation, 0.65, 0.1);  // 15 % of the samples are lost
    EXPECT_LT(correlated.effective_samples, 0.35 * white.effective_samples);
    EXPECT_GT(correlated.curve_w, 1.5 * white.curve_w);
}

}  // namespace
}  // namespace flightwatt::mechanical
