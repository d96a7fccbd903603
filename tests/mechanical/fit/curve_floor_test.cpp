#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

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

TEST(CurveFloor, LeavesACurveAloneThatStaysAboveIt) {
    for (const auto phase : flight::all_phases) {
        EXPECT_FALSE(fit_phase(phase, test::record_flights(phase, 4, 0.01, 2)).is_clamped) << to_string(phase);
    }
}

TEST(CurveFloor, IsNotNegativeWhereNoNegativePowerWasMeasured) {
    const std::vector flights{idle_with_a_pull(0.2)};
    const auto fit = fit_phase(flight::Phase::landing, flights);
    EXPECT_TRUE(fit.is_clamped);
    EXPECT_GE(least_of(fit), 0.0);
    EXPECT_NEAR(energy_j(fit.flights[0].fourier, 40.0) / 40.0, mean_power_w(flights[0]), 0.2);
}

TEST(CurveFloor, MayBeNegativeWhereThatWasMeasured) {
    const std::vector flights{idle_with_a_pull(-5.0)};
    const auto fit = fit_phase(flight::Phase::landing, flights);
    EXPECT_LT(least_of(fit), -4.0);
    EXPECT_FALSE(fit.is_clamped);
    EXPECT_NEAR(energy_j(fit.flights[0].fourier, 40.0) / 40.0, mean_power_w(flights[0]), 0.3);
}

TEST(CurveFloor, KeepsTheMeanPower) {
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
    const auto fit = fit_phase(flight::Phase::landing, flights);
    ASSERT_TRUE(fit.is_clamped) << "else the series proves nothing";
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& flight = fit.flights[i];
        const auto curve = curve_w(flight.fourier, flight.duration_s, 2000);
        EXPECT_GE(*std::ranges::min_element(curve), 0.0);
        EXPECT_NEAR(energy_j(flight.fourier, flight.duration_s) / flight.duration_s, mean_power_w(flights[i]), 0.5);
    }
}

}  // namespace
}  // namespace flightwatt::mechanical
