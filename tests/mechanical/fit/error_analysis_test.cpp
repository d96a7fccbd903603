#include "mechanical/fit/error_analysis.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"

#include <cmath>
#include <numbers>
#include <string>
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
    result.weights = flight_weights(result.fit, phase, {Weighting::uniform, {}});
    result.analysis = analyse_errors(flights, result.fit, result.weights);
    result.flights = std::move(flights);
    return result;
}

TEST(ErrorAnalysis, OfPreciseSamplesIsTheCovarianceOfTheTextbook) {
    // Little noise: the curve is linear in all that is not known, and sigma^2 (J^T J)^-1 is right.
    const auto one = analysed(test::record_flights(flight::Phase::cruise, 1, 0.05, 1), flight::Phase::cruise);
    const auto& samples = one.flights[0];
    const auto at = fourier_residual({samples.tau, samples.power_w}, one.fit.theta_rad,
                                     coefficients_of(one.fit.flights[0].fourier));
    Eigen::MatrixXd jacobian(at.residual.size(), 1 + at.by_coefficients.cols());
    jacobian << at.by_theta, at.by_coefficients;
    const auto freedom = static_cast<double>(jacobian.rows() - jacobian.cols());
    const Eigen::MatrixXd covariance =
        at.residual.squaredNorm() / freedom * (jacobian.transpose() * jacobian).inverse();
    const auto& errors = one.analysis.errors;
    // The autocorrelation is integrated over, about 0.
    const double wider = std::sqrt((1.0 + errors.autocorrelation) / (1.0 - errors.autocorrelation));
    EXPECT_NEAR(errors.omega_rad_per_s * samples.duration_s, wider * std::sqrt(covariance(0, 0)),
                0.15 * std::sqrt(covariance(0, 0)));
    EXPECT_NEAR(errors.a0_w, wider * std::sqrt(covariance(1, 1)), 0.15 * std::sqrt(covariance(1, 1)));
    EXPECT_NEAR(errors.degrees_of_freedom, static_cast<double>(one.fit.samples) - 7.0, 1e-6);
}

TEST(ErrorAnalysis, IntervalsHoldTheFitAndBecomeNarrowWithTheNoise) {
    for (const auto phase : flight::all_phases) {
        double before = 1e9;
        for (const double noise_w : {1.0, 0.3, 0.1}) {
            const auto found = analysed(test::record_flights(phase, 2, noise_w, 3), phase);
            const auto& intervals = found.analysis.errors.intervals.value();
            const auto mean = average_phase(found.fit, found.weights).fourier;
            EXPECT_LE(intervals.a0_w.low, mean.a0_w);
            EXPECT_GE(intervals.a0_w.high, mean.a0_w);
            for (std::size_t n = 0; n < 3; ++n) {
                EXPECT_LE(intervals.cos_w[n].low, mean.cos_w[n]);
                EXPECT_GE(intervals.sin_w[n].high, mean.sin_w[n]);
            }
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

TEST(ErrorAnalysis, AtABoundTheFrequencyIsOpen) {
    const auto bound =
        analysed(test::record_flights(flight::Phase::cruise, 2, 0.2, 8), flight::Phase::cruise, {.min_theta_rad = 5.3});
    EXPECT_FALSE(bound.analysis.errors.frequency_is_fixed);
    const auto profile = frequency_profile(bound.flights, bound.fit, bound.analysis);
    EXPECT_TRUE(profile.low_is_open);
    EXPECT_NEAR(profile.low_rad, 5.3, 1e-2);
}

TEST(ErrorAnalysis, GoodnessOfFit) {
    const auto exact = analysed(test::record_flights(flight::Phase::cruise, 2, 0.0, 6), flight::Phase::cruise);
    EXPECT_NEAR(exact.analysis.errors.r2, 1.0, 1e-12);
    EXPECT_LT(exact.analysis.errors.curve_w, 1e-8);
    const auto landing = analysed(test::record_flights(flight::Phase::landing, 2, 0.1, 6), flight::Phase::landing);
    EXPECT_GT(landing.analysis.errors.condition, 10.0);  // 38 on evenly spread samples at the truth
    EXPECT_LT(landing.analysis.errors.condition, 200.0);
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
    const auto profile = frequency_profile(constant.flights, constant.fit, constant.analysis);
    EXPECT_TRUE(profile.low_is_open && profile.high_is_open);
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

TEST(FrequencyProfile, IsLowestAtTheFrequencyFoundAndAgreesWithItsStandardError) {
    const auto fit = analysed(test::record_flights(flight::Phase::cruise, 3, 0.2, 3), flight::Phase::cruise);
    const auto profile = frequency_profile(fit.flights, fit.fit, fit.analysis);
    ASSERT_EQ(profile.theta_rad.size(), 41U);
    EXPECT_FALSE(profile.low_is_open || profile.high_is_open);
    EXPECT_NEAR(profile.theta_rad[20], fit.fit.theta_rad, 1e-12);
    for (std::size_t i = 1; i <= 20; ++i) EXPECT_LT(profile.rms_w[i], profile.rms_w[i - 1]);
    for (std::size_t i = 21; i < 41; ++i) EXPECT_GT(profile.rms_w[i], profile.rms_w[i - 1]);
    EXPECT_NEAR(profile.rms_w[20], fit.fit.rms_w, 1e-9);
    double duration_s = 0.0;
    for (const auto& flight : fit.flights) duration_s += flight.duration_s / 3.0;
    const double half_width = 1.96 * fit.analysis.errors.omega_rad_per_s * duration_s;
    EXPECT_NEAR(profile.high_rad - fit.fit.theta_rad, half_width, 0.2 * half_width);
    EXPECT_NEAR(fit.fit.theta_rad - profile.low_rad, half_width, 0.2 * half_width);
}

TEST(FrequencyProfile, OfANoisyLandingIsOpenBelow) {
    const auto fit = analysed(test::record_flights(flight::Phase::landing, 1, 0.5, 2), flight::Phase::landing);
    const auto profile = frequency_profile(fit.flights, fit.fit, fit.analysis);
    EXPECT_TRUE(profile.low_is_open);
    EXPECT_NEAR(profile.low_rad, std::numbers::pi, 0.1);
}

const std::vector<double> with_gaps{0.0, 0.1, 0.2, 0.5, 0.55, 0.9, 1.0};

/// The correlation matrix, entry by entry.
Eigen::MatrixXd full_matrix(const std::vector<double>& tau, double step, double autocorrelation) {
    const auto count = static_cast<Eigen::Index>(tau.size());
    Eigen::MatrixXd matrix(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j < count; ++j) {
            const double gap = std::abs(tau[static_cast<std::size_t>(i)] - tau[static_cast<std::size_t>(j)]);
            matrix(i, j) = std::pow(autocorrelation, gap / step);
        }
    }
    return matrix;
}

TEST(ResidualCorrelation, EffectiveSamplesAreThoseOfTheWholeMatrix) {
    const auto correlation = sample_correlation(with_gaps, 0.1, 0.6);
    EXPECT_NEAR(effective_samples(correlation), 49.0 / full_matrix(with_gaps, 0.1, 0.6).sum(), 1e-12);
}

TEST(ResidualCorrelation, EffectiveSamplesAreThoseOfTheTextbookWithoutGaps) {
    std::vector<double> tau;
    for (int i = 0; i < 20000; ++i) tau.push_back(i / 20000.0);
    EXPECT_NEAR(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.5)), 20000.0 / 3.0, 2.0);
    EXPECT_DOUBLE_EQ(effective_samples(sample_correlation(tau, 1.0 / 20000.0, 0.0)), 20000.0);
}

}  // namespace
}  // namespace flightwatt::mechanical
