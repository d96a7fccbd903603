#include "mechanical/fit/joint_fit.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/fourier_basis.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/mechanical_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

std::vector<PhaseSamples> one_flight(const PhaseModel& phase, double noise_w, unsigned seed) {
    std::mt19937 random(seed);
    return {test::centred(test::record(phase, {phase.duration_s, 0.1, noise_w, 0.0}, random))};
}

double found_frequency(std::span<const PhaseSamples> flights, const FrequencyRange& range) {
    return find_frequency(flights, 3, range, scan_frequencies(flights, 3, range));
}

double resolved(std::span<const PhaseSamples> flights, const FrequencyRange& range, double theta_rad) {
    const auto scan = scan_frequencies(flights, 3, range);
    return resolve_subharmonic(flights, 3, range, scan, {theta_rad, projected_square_sum(flights, 3, theta_rad)});
}

TEST(JointFit, FindsTheLeastOfAFineAndExactSearch) {
    const auto flights = one_flight(test::cruise_of(2.7, {2.0, 0.6, 0.3}, {1.0, -0.2, 0.4}), 1.0, 2);
    const FrequencyRange range{std::numbers::pi, 60.0};
    double least = 1e300;
    double at_rad = 0.0;
    for (double theta_rad = range.low_rad; theta_rad < range.high_rad; theta_rad += 0.01) {
        const double sum = projected_square_sum(flights, 3, theta_rad);
        if (sum < least) {
            least = sum;
            at_rad = theta_rad;
        }
    }
    const double found_rad = found_frequency(flights, range);
    EXPECT_NEAR(found_rad, at_rad, 0.01);
    EXPECT_LE(projected_square_sum(flights, 3, found_rad), least);
}

// theta / 2 and theta / 3 hold a plain oscillation too, as their second and third harmonic.
TEST(JointFit, TakesAPlainOscillationForItsOwnFundamental) {
    const FrequencyRange range{std::numbers::pi, 500.0};
    for (const double periods : {4.2, 10.0, 47.3}) {
        for (unsigned seed = 1; seed <= 10; ++seed) {
            const auto noisy = one_flight(test::cruise_of(periods, {3.0}, {2.0}), 1.5, seed);
            EXPECT_NEAR(found_frequency(noisy, range), 2.0 * std::numbers::pi * periods, 0.1);
        }
        const auto exact = one_flight(test::cruise_of(periods, {3.0}, {2.0}), 0.0, 1);
        EXPECT_NEAR(found_frequency(exact, range), 2.0 * std::numbers::pi * periods, 1e-4);
    }
}

TEST(JointFit, DoesNotTakeOddHarmonicsForNoise) {
    // The second harmonic is by far the strongest: theta is half of the strongest.
    const FrequencyRange range{std::numbers::pi, 500.0};
    const auto flights = one_flight(test::cruise_of(5.0, {0.4, 3.0, 0.0}, {0.0, 2.0, 0.4}), 1.5, 4);
    EXPECT_NEAR(found_frequency(flights, range), 10.0 * std::numbers::pi, 0.1);
    EXPECT_NEAR(resolved(flights, range, 10.0 * std::numbers::pi), 10.0 * std::numbers::pi, 0.1);
}

TEST(JointFit, MovesASubharmonicToTheSimplestFrequency) {
    const FrequencyRange range{std::numbers::pi, 500.0};
    const double theta_rad = 2.0 * std::numbers::pi * 12.0;
    const auto flights = one_flight(test::cruise_of(12.0, {3.0}, {2.0}), 1.5, 5);
    EXPECT_NEAR(resolved(flights, range, theta_rad / 2.0), theta_rad, 0.05);
    EXPECT_NEAR(resolved(flights, range, theta_rad / 3.0), theta_rad, 0.05);
    EXPECT_EQ(resolved(flights, range, theta_rad), theta_rad);
}

TEST(JointFit, KeepsTheTrendOfAShortTakeOff) {
    // Few samples do not distinguish 2 theta from theta by significance alone.
    int doubled = 0;
    for (unsigned seed = 1; seed <= 50; ++seed) {
        std::vector<PhaseSamples> flights;
        for (const auto& samples : test::record_flights(flight::Phase::takeoff, 6, 0.5, seed)) {
            flights.push_back(test::centred(samples));
        }
        doubled += found_frequency(flights, {std::numbers::pi, 25.0}) > 6.5;
    }
    EXPECT_LE(doubled, 2);
}

TEST(JointFit, StaysInTheRange) {
    std::mt19937 random(1);
    const auto phase = test::cruise_of(2.0, {3.0}, {2.0});
    const std::vector flights{test::centred(test::record(phase, {600.0, 1.0, 0.1, 0.0}, random))};
    const FrequencyRange range{12.8, 20.0};  // the answer is 12.57
    const auto scan = scan_frequencies(flights, 1, range);
    EXPECT_NEAR(find_frequency(flights, 1, range, scan), 12.8, 1e-5);
}

TEST(JointFit, RefusesTimesThatDetermineNothing) {
    PhaseSamples samples;
    for (int i = 0; i < 30; ++i) {
        samples.tau.push_back(0.5 * (i % 3));
        samples.power_w.push_back(i % 2 == 0 ? 1.0 : -1.0);
    }
    EXPECT_THROW(fit_at_frequency(std::vector{samples}, 3, 5.0), NoResultError);
}

}  // namespace
}  // namespace flightwatt::mechanical
