#include "mechanical/phase_samples.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(MeanPower, WeighsSamplesByTime) {
    const PhaseSamples samples{"f", 100.0, {0.1, 0.2, 0.8}, {10.0, 10.0, 20.0}};
    EXPECT_NEAR(mean_power_w(samples), 10.0 * 0.2 + 15.0 * 0.6 + 20.0 * 0.2, 1e-12);
}

TEST(MedianGap, CountsNoGapBetweenEqualTimes) {
    EXPECT_DOUBLE_EQ(median_gap({0.1, 0.1, 0.2, 0.5, 0.8}), 0.3);
    EXPECT_EQ(median_gap({0.5, 0.5}), 0.0);
}

constexpr double start_s = 60.0;
constexpr double end_s = 360.0;

/// A cruise from 60 s to 360 s, between other phases.
flight::PhaseSpan cruise() {
    flight::PhaseSpan span;
    span.start.time_s = start_s;
    span.end.time_s = end_s;
    span.start.gap_s = span.end.gap_s = 1.0;
    return span;
}

flight::Track track_of(const std::function<double(double)>& power_w, double noise_w = 0.02) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0.0, noise_w);
    flight::Track track{"power_w"};
    for (double time_s = 0.3; time_s < 420.0; time_s += 1.0) {
        track.time_s.push_back(time_s);
        track.value.push_back(power_w(time_s) + noise(random));
    }
    return track;
}

TEST(EdgeSamples, PowerThatJumpsAtTheEdgeLosesNone) {
    const auto found = count_neighbour_samples(
        track_of([](double time_s) { return time_s < start_s ? 57.0
                                            : time_s < end_s ? 22.0
                                                             : 2.0; }), cruise());
    EXPECT_EQ(found.at_start, 0U);
    EXPECT_EQ(found.at_end, 0U);
}

TEST(EdgeSamples, TakeOffPowerInTheCruiseIsTheTakeOffs) {
    // The jump is at 61.5 s, and one sample holds both.
    const auto power = [](double time_s) {
        return time_s < 61.0 ? 57.0 : time_s < 62.0 ? 35.0 : time_s < 359.0 ? 22.0 : 2.0;
    };
    const auto found = count_neighbour_samples(track_of(power), cruise());
    EXPECT_EQ(found.at_start, 2U);
    EXPECT_EQ(found.at_end, 1U);
}

TEST(EdgeSamples, OneSampleBetweenBothPowersCountsToo) {
    const auto power = [](double time_s) { return time_s < start_s ? 57.0 : time_s < 61.0 ? 34.7 : 22.0; };
    EXPECT_EQ(count_neighbour_samples(track_of(power), cruise()).at_start, 1U);
}

TEST(EdgeSamples, WhatIsFurtherFromTheEdgeThanItIsKnownStays) {
    const auto power = [](double time_s) { return time_s < 70.0 ? 57.0 : 22.0; };
    const auto found = count_neighbour_samples(track_of(power), cruise());
    EXPECT_EQ(found.at_start, 0U);
}

TEST(EdgeSamples, SmoothPowerLosesNone) {
    const auto smooth = [](double time_s) { return 30.0 + 8.0 * std::sin(time_s / 9.0); };
    for (const double noise_w : {0.001, 0.02, 1.0}) {
        const auto found = count_neighbour_samples(track_of(smooth, noise_w), cruise());
        EXPECT_EQ(found.at_start + found.at_end, 0U) << noise_w;
    }
}

TEST(EdgeSamples, AJumpWithinTheNoiseLosesNone) {
    const auto power = [](double time_s) { return time_s < 61.0 ? 23.0 : 22.0; };
    const auto found = count_neighbour_samples(track_of(power, 1.0), cruise());
    EXPECT_EQ(found.at_start, 0U);
}

TEST(EdgeSamples, AtAnEndOfTheRecordThereIsNoNeighbour) {
    auto span = cruise();
    span.start.time_s = 0.0;
    const auto power = [](double time_s) { return time_s < 2.0 ? 57.0 : 22.0; };
    EXPECT_EQ(count_neighbour_samples(track_of(power), span).at_start, 0U);
}

}  // namespace
}  // namespace flightwatt::mechanical
