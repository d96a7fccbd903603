#include "mechanical/uncertainty/error_analysis.h"

#include "helpers/made_up_flights.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/uncertainty/frequency_profile.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/QR>
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

/// The errors of one flight as any textbook has them: sigma^2 (J^T J)^-1 of the whole dense problem.
Eigen::MatrixXd textbook_covariance(const Analysed& one) {
    const auto& samples = one.flights[0];
    const auto at = fourier_residual({samples.tau, samples.power_w}, one.fit.theta_rad,
                                     coefficients_of(one.fit.flights[0].fourier));
    Eigen::MatrixXd jacobian(at.residual.size(), 1 + at.by_coefficients.cols());
    jacobian << at.by_theta, at.by_coefficients;
    const auto freedom = static_cast<double>(jacobian.rows() - jacobian.cols());
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(jacobian);
    const Eigen::MatrixXd inverse = qr.matrixQR()
                                        .topRows(jacobian.cols())
                                        .triangularView<Eigen::Upper>()
                                        .solve(Eigen::MatrixXd::Identity(jacobian.cols(), jacobian.cols()));
    return at.residual.squaredNorm() / freedom * inverse * inverse.transpose();
}

/// Flights whose levels differ by a few times `apart_w`, each with the same swing that is too fast for the series: its
/// residuals are alike from sample to sample for as long as the phase lasts.
std::vector<PhaseSamples> swinging_flights(double apart_w) {
    constexpr int samples = 600;
    std::vector<PhaseSamples> flights;
    for (int flight = 0; flight < 4; ++flight) {
        PhaseSamples made{"f" + std::to_string(flight), 60.0, {}, {}};
        for (int j = 0; j < samples; ++j) {
            const double tau = static_cast<double>(j) / (samples - 1);
            made.tau.push_back(tau);
            made.power_w.push_back(60.0 + apart_w * flight + 10.0 * std::sin(5.0 * tau) +
                                   6.0 * std::sin(2.0 * std::numbers::pi * 7.3 * tau));
        }
        flights.push_back(std::move(made));
    }
    return flights;
}

TEST(ErrorAnalysis, TakesTheDifferencesOfFlightsWhereTheNoiseTellsLess) {
    const auto alike = analysed(swinging_flights(0.05), flight::Phase::takeoff).analysis.errors;
    EXPECT_EQ(alike.autocorrelation, highest_autocorrelation);
    EXPECT_TRUE(alike.from_flights);
    EXPECT_NEAR(alike.curve_w, 0.05 * 1.29 / 2.0, 0.01);  // sd of 0, 1, 2, 3 is 1.29
    EXPECT_NEAR(alike.degrees_of_freedom, 3.0, 1e-9);
    const auto apart = analysed(swinging_flights(50.0), flight::Phase::takeoff).analysis.errors;
    EXPECT_FALSE(apart.from_flights);
}

TEST(ErrorAnalysis, WithoutCorrelationIsTheCovarianceOfTheTextbook) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const auto one = analysed(test::record_flights(flight::Phase::cruise, 1, 0.3, seed), flight::Phase::cruise);
        if (one.analysis.errors.autocorrelation > 0.0) continue;
        const auto expected = textbook_covariance(one);
        EXPECT_LT((one.analysis.covariance - expected).norm(), 1e-6 * expected.norm());
        EXPECT_DOUBLE_EQ(one.analysis.errors.effective_samples, static_cast<double>(one.fit.samples));
        EXPECT_NEAR(one.analysis.errors.degrees_of_freedom, static_cast<double>(one.fit.samples) - 8.0, 1e-6);
        return;
    }
    FAIL() << "none of the flights had uncorrelated residuals";
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

TEST(ErrorAnalysis, AtABoundTheFrequencyIsTakenAsGiven) {
    const auto bound =
        analysed(test::record_flights(flight::Phase::cruise, 2, 0.2, 8), flight::Phase::cruise, {.low_rad = 5.3});
    EXPECT_TRUE(bound.analysis.errors.frequency_is_given);
    EXPECT_EQ(bound.analysis.errors.omega_rad_per_s, 0.0);
    EXPECT_EQ(bound.analysis.covariance.row(0).cwiseAbs().maxCoeff(), 0.0);
    EXPECT_GT(bound.analysis.free_theta_rad, 0.0);
    const auto profile = frequency_profile(bound.flights, bound.fit, bound.analysis);
    EXPECT_TRUE(profile.low_is_open);
    EXPECT_NEAR(profile.low_rad, 5.3, 1e-4);
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
    EXPECT_TRUE(constant.analysis.errors.frequency_is_given);
    EXPECT_LT(constant.analysis.errors.a0_w, 1e-10);
    const auto profile = frequency_profile(constant.flights, constant.fit, constant.analysis);
    EXPECT_TRUE(profile.low_is_open && profile.high_is_open);
}

TEST(ErrorAnalysis, OrderZeroIsTheErrorOfTheMean) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(1.0, {}, {});
    const auto samples = test::record(phase, {600.0, 1.0, 0.5, 0.0}, random);
    const auto constant = analysed({samples}, flight::Phase::cruise, {.order = 0});
    EXPECT_NEAR(constant.fit.flights[0].fourier.a0_w, 27.22, 0.1);
    EXPECT_NEAR(constant.analysis.errors.a0_w, 0.5 / std::sqrt(600.0), 0.004);
    EXPECT_TRUE(constant.analysis.errors.frequency_is_given);
}

TEST(FrequencyProfile, IsLowestAtTheFrequencyFoundAndAgreesWithItsStandardError) {
    const auto fit = analysed(test::record_flights(flight::Phase::cruise, 3, 0.2, 3), flight::Phase::cruise);
    const auto profile = frequency_profile(fit.flights, fit.fit, fit.analysis);
    ASSERT_EQ(profile.theta_rad.size(), 41U);
    EXPECT_FALSE(profile.low_is_open || profile.high_is_open);
    EXPECT_DOUBLE_EQ(profile.theta_rad[20], fit.fit.theta_rad);
    for (std::size_t i = 1; i <= 20; ++i) EXPECT_LT(profile.rms_w[i], profile.rms_w[i - 1]);
    for (std::size_t i = 21; i < 41; ++i) EXPECT_GT(profile.rms_w[i], profile.rms_w[i - 1]);
    EXPECT_NEAR(profile.rms_w[20], fit.fit.rms_w, 1e-9);
    const double half_width = 1.96 * fit.analysis.free_theta_rad;
    EXPECT_NEAR(profile.high_rad - fit.fit.theta_rad, half_width, 0.1 * half_width);
    EXPECT_NEAR(fit.fit.theta_rad - profile.low_rad, half_width, 0.1 * half_width);
}

TEST(FrequencyProfile, OfANoisyLandingIsOpenBelow) {
    const auto fit = analysed(test::record_flights(flight::Phase::landing, 1, 0.5, 2), flight::Phase::landing);
    const auto profile = frequency_profile(fit.flights, fit.fit, fit.analysis);
    EXPECT_TRUE(profile.low_is_open);
    EXPECT_NEAR(profile.low_rad, std::numbers::pi, 1e-6);
}

}  // namespace
}  // namespace flightwatt::mechanical
