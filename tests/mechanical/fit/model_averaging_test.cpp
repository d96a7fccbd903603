#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

double off_by_w(const PhaseFit& fit, const PhaseModel& truth) {
    const auto true_w = curve_w(truth.fourier, truth.duration_s, 1000);
    const auto fitted_w = curve_w(fit.flights[0].fourier, fit.flights[0].duration_s, 1000);
    double square_w2 = 0.0;
    for (std::size_t i = 0; i < 1000; ++i) square_w2 += std::pow(fitted_w[i] - true_w[i], 2) / 1000.0;
    return std::sqrt(square_w2);
}

TEST(ModelAveraging, IsNearerToTheTruthWhereTheFrequencyIsOpen) {
    const auto phase = flight::Phase::landing;
    const auto truth = test::published_model().phases[phase];
    double of_mean_w = 0.0;
    double of_least_squares_w = 0.0;
    int means = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const auto flights = test::record_flights(phase, 1, 1.0, seed);
        const auto fit = fit_phase(phase, flights);
        means += fit.is_frequency_averaged ? 1 : 0;
        of_mean_w += off_by_w(fit, truth);
        of_least_squares_w += off_by_w(fit_phase(phase, flights, {.curve = CurveEstimator::least_squares}), truth);
    }
    EXPECT_GE(means, 6);
    EXPECT_LT(of_mean_w, 0.85 * of_least_squares_w);
}

TEST(ModelAveraging, LeavesAFitAloneWhoseFrequencyIsDetermined) {
    for (const auto phase : flight::all_phases) {
        const auto flights = test::record_flights(phase, 4, 0.01, 2);
        const auto fit = fit_phase(phase, flights);
        const auto plain = fit_phase(phase, flights, {.curve = CurveEstimator::least_squares});
        EXPECT_FALSE(fit.is_frequency_averaged || fit.is_clamped) << to_string(phase);
        EXPECT_EQ(fit.theta_rad, plain.theta_rad);
        EXPECT_EQ(fit.flights[0].fourier.a0_w, plain.flights[0].fourier.a0_w);
    }
}

TEST(ModelAveraging, LeavesADeterminedFrequencyAloneWhereLeastSquaresIsNotTheBestUseOfTheFlights) {
    // One flight is a hundred times as exact: least squares, to which all samples are alike, is many standard errors
    // off, and yet no other curve is meant.
    const auto phase = flight::Phase::cruise;
    auto flights = test::record_flights(phase, 1, 0.003, 1);
    flights.push_back(test::record_flights(phase, 1, 0.3, 2)[0]);
    flights[1].flight = "noisy";
    const auto fit = fit_phase(phase, flights);
    const auto plain = fit_phase(phase, flights, {.curve = CurveEstimator::least_squares});
    EXPECT_FALSE(fit.is_frequency_averaged);
    EXPECT_EQ(fit.theta_rad, plain.theta_rad);
}

/// A motor that idles but for one pull up in the middle, with noise.
PhaseSamples idle_with_a_pull(double min_w) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, 0.05);
    PhaseSamples samples{"idle", 40.0, {}, {}};
    for (int i = 0; i < 40; ++i) {
        samples.tau.push_back((i + 0.5) / 40.0);
        const double pull_w = i >= 18 && i < 22 ? 20.0 : 0.0;
        samples.power_w.push_back(std::max(min_w, min_w + pull_w + noise(random)));
    }
    return samples;
}

double least_of(const PhaseFit& fit) {
    const auto curve = curve_w(fit.flights[0].fourier, fit.flights[0].duration_s, 2000);
    return *std::ranges::min_element(curve);
}

TEST(ModelAveraging, IsNotNegativeWhereNoNegativePowerWasMeasured) {
    const std::vector flights{idle_with_a_pull(0.2)};
    const auto plain = fit_phase(flight::Phase::landing, flights, {.curve = CurveEstimator::least_squares});
    ASSERT_LT(least_of(plain), -0.1);
    const auto fit = fit_phase(flight::Phase::landing, flights);
    EXPECT_TRUE(fit.is_clamped);
    EXPECT_GE(least_of(fit), 0.0);
    EXPECT_LT(fit.rms_w, 2.0 * plain.rms_w);
}

TEST(ModelAveraging, MayBeNegativeWhereThatWasMeasured) {
    const std::vector flights{idle_with_a_pull(-5.0)};
    const auto fit = fit_phase(flight::Phase::landing, flights);
    EXPECT_LT(least_of(fit), -4.0);
    EXPECT_GE(least_of(fit), *std::ranges::min_element(flights[0].power_w) - 1e-6);
}

TEST(ModelAveraging, IsNotNegativeForTheSakeOfAFewSamples) {
    std::vector flights{idle_with_a_pull(0.2)};
    flights[0].power_w[30] = flights[0].power_w[31] = -3.0;
    EXPECT_GE(least_of(fit_phase(flight::Phase::landing, flights)), 0.0);
}

TEST(ModelAveraging, KeepsTheMeanPowerAndHasPlausibleConstants) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, 0.3);
    std::vector<PhaseSamples> flights;
    for (const double burst_w : {9.0, 16.0, 12.0}) {  // an idle descent with a burst before touchdown
        PhaseSamples samples{"descent", 36.0, {}, {}};
        for (int i = 0; i < 24; ++i) {
            samples.tau.push_back((i + 0.5) / 24.0);
            samples.power_w.push_back((i < 20 ? 0.2 : burst_w * (i - 19) / 4.0) + noise(random));
        }
        flights.push_back(std::move(samples));
    }
    const auto plain = fit_phase(flight::Phase::landing, flights, {.curve = CurveEstimator::least_squares});
    const auto negative = curve_w(plain.flights[1].fourier, plain.flights[1].duration_s, 2000);
    ASSERT_LT(*std::ranges::min_element(negative), -0.2) << "else the series proves nothing";
    const auto fit = fit_phase(flight::Phase::landing, flights);
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& flight = fit.flights[i];
        const double most = *std::ranges::max_element(flights[i].power_w);
        EXPECT_GE(flight.fourier.a0_w, 0.0);
        EXPECT_LE(flight.fourier.a0_w, most);
        const auto curve = curve_w(flight.fourier, flight.duration_s, 2000);
        EXPECT_GE(*std::ranges::min_element(curve), 0.0);
        EXPECT_NEAR(energy_j(flight.fourier, flight.duration_s) / flight.duration_s, mean_power_w(flights[i]), 0.5);
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
