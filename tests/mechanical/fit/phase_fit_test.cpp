#include "mechanical/fit/phase_fit.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::AllOf;
using testing::HasSubstr;

template <typename Error>
std::string message_of(const std::vector<PhaseSamples>& flights, const PhaseFitOptions& options = {}) {
    try {
        fit_phase(flight::Phase::cruise, flights, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "fitted without complaint";
}

/// The least standard deviation that an unbiased estimate of theta can have (Cramer and Rao).
double least_deviation_rad(const PhaseModel& phase, const PhaseSamples& samples, double noise_w) {
    Eigen::VectorXd coefficients(coefficient_count(static_cast<int>(phase.fourier.cos_w.size())));
    coefficients(0) = phase.fourier.a0_w;
    for (std::size_t n = 0; n < phase.fourier.cos_w.size(); ++n) {
        coefficients(static_cast<Eigen::Index>(2 * n + 1)) = phase.fourier.cos_w[n];
        coefficients(static_cast<Eigen::Index>(2 * n + 2)) = phase.fourier.sin_w[n];
    }
    constexpr double step_rad = 1e-5;
    const double theta_rad = test::theta_rad(phase);
    const Eigen::VectorXd by_theta = (residual_of(samples, theta_rad + step_rad, coefficients) -
                                      residual_of(samples, theta_rad - step_rad, coefficients)) /
                                     (2.0 * step_rad);
    const auto basis = fourier_basis(samples.tau, static_cast<int>(phase.fourier.cos_w.size()), theta_rad);
    return noise_w / std::sqrt(solve_least_squares(basis, by_theta)->residual_square_sum);
}

TEST(PhaseFit, RecoversTableOneFromExactSamples) {
    for (const auto phase : flight::all_phases) {
        for (const double interval_s : {0.1, 1.1}) {
            const auto published = test::published_model().phases[phase];
            std::mt19937 random(1);
            const auto samples = test::record(published, {published.duration_s, interval_s, 0.0, 0.0}, random);
            const auto fit = fit_phase(phase, std::vector{samples});
            // Far below the frequency's error of real samples, some 0.01 rad.
            EXPECT_NEAR(fit.theta_rad, test::theta_rad(published), 1e-5) << to_string(phase);
            EXPECT_LT(fit.rms_w, 1e-5);
            const auto& curve = fit.flights.front().fourier;
            EXPECT_NEAR(curve.omega_rad_per_s, published.fourier.omega_rad_per_s, 1e-6);
            EXPECT_NEAR(curve.a0_w, published.fourier.a0_w, 1e-4);
            for (std::size_t n = 0; n < 3; ++n) {
                EXPECT_NEAR(curve.cos_w[n], published.fourier.cos_w[n], 1e-4);
                EXPECT_NEAR(curve.sin_w[n], published.fourier.sin_w[n], 1e-4);
            }
        }
    }
}

// Amplitudes are such that one per cent is three deviations or more of the best possible estimate at one
// period.
struct Series {
    const char* name;
    std::vector<double> cos_w;
    std::vector<double> sin_w;
};

class FrequencyIdentification : public testing::TestWithParam<Series> {};

TEST_P(FrequencyIdentification, IsWithinOnePerCentEveryTime) {
    for (const double periods : {1.0, 1.3, 4.2, 10.0}) {
        for (unsigned seed = 1; seed <= 10; ++seed) {
            std::mt19937 random(seed);
            const auto phase = test::cruise_of(periods, GetParam().cos_w, GetParam().sin_w);
            const auto samples = test::record(phase, {600.0, 0.1, 1.5, 0.0}, random);
            const auto fit = fit_phase(flight::Phase::cruise, std::vector{samples});
            const auto& found = fit.flights.front().fourier;
            EXPECT_NEAR(found.omega_rad_per_s / phase.fourier.omega_rad_per_s, 1.0, 0.01)
                << periods << " periods, seed " << seed;
            EXPECT_NEAR(fit.rms_w, 1.5, 0.05);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(PhaseFit, FrequencyIdentification,
                         testing::Values(Series{"CruiseOfTableOneTimesFour",
                                                {4 * 0.3737, 4 * 0.6513, 4 * 0.5039},
                                                {4 * 1.194, 4 * 0.2954, 4 * -0.2864}},
                                         Series{"FundamentalWithWeakHarmonics", {9.0, 0.6, 0.3}, {6.0, -0.3, 0.3}}),
                         [](const auto& test) { return test.param.name; });

TEST(PhaseFit, EstimatesTheFrequencyAsWellAsTheNoiseAllows) {
    const auto published = test::published_model().phases[flight::Phase::cruise];
    double square_sum = 0.0;
    double least_rad = 0.0;
    constexpr unsigned seeds = 60;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        std::mt19937 random(seed);
        const auto samples = test::record(published, {600.0, 1.1, 0.3, 0.0}, random);
        const auto fit = fit_phase(flight::Phase::cruise, std::vector{samples});
        square_sum += std::pow(fit.theta_rad - test::theta_rad(published), 2);
        least_rad = least_deviation_rad(published, samples, 0.3);
    }
    EXPECT_LT(std::sqrt(square_sum / seeds), 1.3 * least_rad);
    EXPECT_GT(std::sqrt(square_sum / seeds), 0.7 * least_rad);
}

TEST(PhaseFit, GapsAndUnequalStepsDoNotMatter) {
    const auto published = test::published_model().phases[flight::Phase::cruise];
    std::mt19937 random(3);
    auto samples = test::record(published, {600.0, 1.1, 0.0, 0.5}, random);
    const auto in_gap = [](double tau) { return tau > 0.4 && tau < 0.44; };
    PhaseSamples kept{samples.flight, samples.duration_s, {}, {}};
    for (std::size_t i = 0; i < samples.tau.size(); ++i) {
        if (in_gap(samples.tau[i])) continue;
        kept.tau.push_back(samples.tau[i]);
        kept.power_w.push_back(samples.power_w[i]);
    }
    EXPECT_NEAR(fit_phase(flight::Phase::cruise, std::vector{kept}).theta_rad, test::theta_rad(published), 1e-5);
}

TEST(PhaseFit, AThousandfoldPowerHasThousandfoldCoefficients) {
    for (const auto phase : flight::all_phases) {
        const auto flights = test::record_flights(phase, 3, 0.1, 5);
        auto thousandfold = flights;
        for (auto& flight : thousandfold) {
            for (double& power : flight.power_w) power *= 1000.0;
        }
        const auto fit = fit_phase(phase, flights);
        const auto scaled = fit_phase(phase, thousandfold);
        EXPECT_NEAR(scaled.theta_rad, fit.theta_rad, 1e-6);
        EXPECT_NEAR(scaled.rms_w, 1000.0 * fit.rms_w, 1e-6 * scaled.rms_w);
        for (std::size_t i = 0; i < fit.flights.size(); ++i) {
            const auto& small = fit.flights[i].fourier;
            const auto& large = scaled.flights[i].fourier;
            EXPECT_NEAR(large.a0_w, 1000.0 * small.a0_w, 1e-5 * large.a0_w);
            for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(large.cos_w[n], 1000.0 * small.cos_w[n], 1e-5 * large.a0_w);
        }
    }
}

TEST(PhaseFit, TheOrderOfTheFlightsDoesNotMatter) {
    const auto flights = test::record_flights(flight::Phase::landing, 5, 0.1, 6);
    auto turned = flights;
    std::rotate(turned.begin(), turned.begin() + 2, turned.end());
    const auto fit = fit_phase(flight::Phase::landing, flights);
    const auto again = fit_phase(flight::Phase::landing, turned);
    EXPECT_NEAR(again.theta_rad, fit.theta_rad, 1e-6);
    EXPECT_NEAR(again.rms_w, fit.rms_w, 1e-9);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(again.flights[i].flight, fit.flights[(i + 2) % 5].flight);
        EXPECT_NEAR(again.flights[i].fourier.a0_w, fit.flights[(i + 2) % 5].fourier.a0_w, 1e-5);
    }
}

TEST(PhaseFit, TheSharedFrequencyIsTheSameForTwinsAsForOne) {
    const auto one = test::record_flights(flight::Phase::cruise, 1, 0.5, 7);
    std::vector<PhaseSamples> twins{one.front(), one.front()};
    twins[1].flight = "twin";
    EXPECT_NEAR(fit_phase(flight::Phase::cruise, twins).theta_rad, fit_phase(flight::Phase::cruise, one).theta_rad,
                1e-6);
}

TEST(PhaseFit, StaysWithinTheRange) {
    std::mt19937 random(8);
    const auto phase = test::cruise_of(0.4, {3.0}, {2.0});
    const auto low = fit_phase(flight::Phase::cruise, std::vector{test::record(phase, {600.0, 1.0, 0.0, 0.0}, random)},
                               {.order = 1});
    EXPECT_NEAR(low.theta_rad, std::numbers::pi, 1e-5);
}

TEST(PhaseFit, SaysWhereTheSamplesLeaveTheFrequencyOpen) {
    for (const auto phase : flight::all_phases) {
        EXPECT_TRUE(fit_phase(phase, test::record_flights(phase, 4, 0.01, 2)).rivals_rad.empty()) << to_string(phase);
    }
    int open = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const auto landings = test::record_flights(flight::Phase::landing, 1, 1.0, seed);
        open += fit_phase(flight::Phase::landing, landings).rivals_rad.empty() ? 0 : 1;
    }
    EXPECT_GE(open, 5) << "of 6 landings with 1 W of noise";
}

TEST(PhaseFit, TheRangeEndsWhereTheHighestHarmonicOutrunsTheSamples) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(2.0, {3.0}, {2.0});
    const auto coarse = test::record(phase, {600.0, 2.0, 0.0, 0.0}, random);
    const auto fine = test::record(phase, {600.0, 0.1, 0.0, 0.0}, random);
    // Two samples a period are pi 300 / order; evenly spread ones show both columns 1.9 rad of the phase below.
    EXPECT_NEAR(admissible_frequencies(std::vector{fine, coarse}, {}).high_rad, (std::numbers::pi * 300.0 - 1.9) / 3.0,
                0.07);
    EXPECT_NEAR(admissible_frequencies(std::vector{fine, coarse}, {.order = 5}).high_rad,
                (std::numbers::pi * 300.0 - 1.9) / 5.0, 0.07);
    EXPECT_NEAR(admissible_frequencies(std::vector{fine}, {}).high_rad, 240.0 * std::numbers::pi, 1e-9);  // the cap
    EXPECT_EQ(admissible_frequencies(std::vector{fine}, {}).low_rad, std::numbers::pi);
}

TEST(PhaseFit, RegularSeriesHaveNoWildCurves) {
    for (const auto phase : {flight::Phase::takeoff, flight::Phase::landing}) {
        const auto truth = test::published_model().phases[phase];
        const auto true_w = curve_w(truth.fourier, truth.duration_s, 1000);
        for (unsigned seed = 20000; seed < 20015; ++seed) {
            std::mt19937 random(seed);
            const auto samples = test::record(truth, {truth.duration_s, 1.1, 1.0, 0.15}, random);
            const auto fit = fit_phase(phase, std::vector{samples});
            const auto fitted_w = curve_w(fit.flights[0].fourier, truth.duration_s, 1000);
            double square_w2 = 0.0;
            for (std::size_t i = 0; i < 1000; ++i) square_w2 += std::pow(fitted_w[i] - true_w[i], 2) / 1000.0;
            EXPECT_LT(std::sqrt(square_w2), 3.0) << to_string(phase) << " seed " << seed;
        }
    }
}

TEST(PhaseFit, ConstantPowerIsItsOwnMean) {
    PhaseSamples samples{"flight", 60.0, {}, {}};
    for (int i = 0; i < 50; ++i) {
        samples.tau.push_back((i + 0.5) / 50.0);
        samples.power_w.push_back(21.7);
    }
    const auto fit = fit_phase(flight::Phase::cruise, std::vector{samples});
    EXPECT_NEAR(fit.rms_w, 0.0, 1e-12);
    EXPECT_NEAR(fit.flights.front().fourier.a0_w, 21.7, 1e-12);
    for (const double w : fit.flights.front().fourier.cos_w) EXPECT_EQ(w, 0.0);
}

TEST(PhaseFit, OtherOrdersAreFittedToo) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(3.3, {3.0, 1.0, 0.5, 0.7, 0.4}, {2.0, -1.0, 0.5, 0.1, -0.6});
    const auto samples = test::record(phase, {600.0, 1.0, 0.0, 0.0}, random);
    const auto fit = fit_phase(flight::Phase::cruise, std::vector{samples}, {.order = 5});
    EXPECT_NEAR(fit.theta_rad, test::theta_rad(phase), 1e-5);
    EXPECT_NEAR(fit.flights.front().fourier.sin_w[4], -0.6, 1e-5);
    EXPECT_LT(fit.rms_w, 1e-5);
}

TEST(PhaseFit, RefusesTooFewSamplesNamingTheFlight) {
    auto flights = test::record_flights(flight::Phase::cruise, 2, 0.5, 9);
    flights[1].tau.resize(7);
    flights[1].power_w.resize(7);
    EXPECT_EQ(min_samples(3), 8U);
    EXPECT_THAT(message_of<NoResultError>(flights),
                AllOf(HasSubstr("'flight2' has 7 samples in cruise"), HasSubstr("order 3 needs 8")));
    EXPECT_THAT(message_of<NoResultError>({}), HasSubstr("no flight has a cruise"));
}

TEST(PhaseFit, RefusesSamplesThatLeaveNoRange) {
    PhaseSamples samples{"sparse", 60.0, {}, {}};
    for (int i = 0; i < 12; ++i) {
        samples.tau.push_back(0.5 * (i % 3));
        samples.power_w.push_back(20.0 + i);
    }
    EXPECT_THAT(message_of<NoResultError>({samples}),
                AllOf(HasSubstr("cruise"), HasSubstr("'sparse'"), HasSubstr("too sparse")));
}

TEST(PhaseFit, RefusesOptionsThatMakeNoSense) {
    const auto flights = test::record_flights(flight::Phase::cruise, 1, 0.5, 11);
    EXPECT_THAT(message_of<UsageError>(flights, {.order = -1}), HasSubstr("expected 0 to 8"));
    EXPECT_THAT(message_of<UsageError>(flights, {.order = 9}), HasSubstr("expected 0 to 8"));
}

}  // namespace
}  // namespace flightwatt::mechanical
