#include "mechanical/phase_curve.h"

#include "helpers/made_up_flights.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(PhaseCurve, IsTheSeriesAtTheMiddlesOfEqualParts) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    const auto curve = curve_w(phase.fourier, phase.duration_s, 7);
    ASSERT_EQ(curve.size(), 7U);
    EXPECT_DOUBLE_EQ(curve[0], power_w(phase.fourier, 2.0));
    EXPECT_DOUBLE_EQ(curve[6], power_w(phase.fourier, 26.0));
}

TEST(PhaseCurve, DifferenceIsThatOfTheCurvesWhateverTheSeconds) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    EXPECT_EQ(curve_rms_difference_w(phase, phase), 0.0);
    auto slower = phase;
    slower.duration_s *= 3.0;
    slower.fourier.omega_rad_per_s /= 3.0;
    EXPECT_NEAR(curve_rms_difference_w(phase, slower), 0.0, 1e-12);
    auto higher = phase;
    higher.fourier.a0_w += 0.25;
    EXPECT_NEAR(curve_rms_difference_w(phase, higher), 0.25, 1e-12);
}

TEST(PhaseCurve, ResolvesTheFastestHarmonic) {
    // 250 periods, the third harmonic only: an RMS of 2 / sqrt 2, and no point for it to hide between.
    auto flat = test::cruise_of(250.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
    auto wave = test::cruise_of(250.0, {0.0, 0.0, 2.0}, {0.0, 0.0, 0.0});
    EXPECT_GE(points_of_curve(wave.fourier, wave.duration_s), 12000U);
    EXPECT_NEAR(curve_rms_difference_w(flat, wave), std::numbers::sqrt2, 1e-9);
}

}  // namespace
}  // namespace flightwatt::mechanical
