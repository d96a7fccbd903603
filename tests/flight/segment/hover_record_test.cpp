#include "flight/segment/hover_record.h"

#include "flight/segment.h"
#include "flight/select.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::IsEmpty;

/// Ten samples a second: idle at a quarter of the throttle, hovering from 20 to 60 s and from 70 to 100 s at 1.5 m,
/// with a barometer that drifts by 2 m.
FlightSeries hopping_copter() {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    Track power{.name = "power_w", .source = "BAT.Volt * BAT.Curr"};
    for (int i = 0; i < 1200; ++i) {
        const double time_s = 0.1 * i;
        const bool flies = (time_s >= 20.0 && time_s < 60.0) || (time_s >= 70.0 && time_s < 100.0);
        for (auto* track : {&throttle, &altitude, &power}) track->time_s.push_back(time_s);
        throttle.value.push_back(flies ? 50.0 + i % 3 : 12.0);
        altitude.value.push_back((flies ? 1.5 : 0.0) + time_s / 60.0);
        power.value.push_back(flies ? 200.0 : 30.0);
    }
    series.tracks = {altitude, throttle, power};
    return series;
}

Track state(const char* name, std::vector<double> time_s, std::vector<double> value) {
    return {.name = name, .source = "EV.Id", .time_s = std::move(time_s), .value = std::move(value)};
}

TEST(HoverRecord, IsThatOfARotorcraftHoweverLow) {
    auto series = hopping_copter();
    EXPECT_EQ(segment(select_tracks(series)).sorties.size(), 2U) << "idle motors separate them";
    series.tracks.push_back(state("armed", {5.0}, {1.0}));
    const auto sorties = segment(select_tracks(series)).sorties;
    ASSERT_EQ(sorties.size(), 1U) << "armed throughout, as if it descended";
    EXPECT_NEAR(sorties[0].start_s(), 20.0, 0.6);
    EXPECT_NEAR(sorties[0].end_s(), 99.5, 0.6);
    series.firmware = "fixedwing";
    EXPECT_THAT(segment(select_tracks(series)).sorties, IsEmpty());
}

/// Without a throttle, the current distinguishes hovering from idling.
TEST(HoverRecord, IsToldByACurrentThatLifts) {
    const auto events = [](double current_a, double altitude_m) {
        FlightSeries series;
        series.firmware = "rotorcraft";
        Track altitude{.name = "altitude_m", .source = "ALT"};
        for (int i = 0; i < 600; ++i) {
            altitude.time_s.push_back(0.2 * i);
            altitude.value.push_back(250.0 + altitude_m * std::sin(i / 50.0));
        }
        auto current = altitude;
        current.name = "current_a";
        current.value.assign(600, current_a);
        auto power = current;
        power.name = "power_w";
        for (auto& value : power.value) value *= 24.0;
        series.tracks = {altitude, power, current};
        return segment(select_tracks(series));
    };
    const auto hover = events(19.0, 3.0);
    ASSERT_EQ(hover.sorties.size(), 1U);
    ASSERT_EQ(hover.sorties[0].phases.size(), 1U) << "it begins and ends in the air";
    EXPECT_EQ(hover.sorties[0].phases[0].phase, Phase::cruise);
    EXPECT_FALSE(hover.sorties[0].phases[0].complete);
    EXPECT_THAT(events(1.5, 3.0).sorties, IsEmpty()) << "armed idling";
    ASSERT_EQ(events(19.0, 0.0).ground_events.size(), 1U);
    EXPECT_THAT(events(19.0, 0.0).ground_events[0].what, testing::HasSubstr("altitude within 0.0 m"));
}

TEST(HoverRecord, IsNoneWhileTheAutopilotStatesTheGround) {
    auto series = hopping_copter();
    series.tracks.push_back(state("landed", {0.0}, {1.0}));
    const auto phases = segment(select_tracks(series));
    EXPECT_THAT(phases.sorties, IsEmpty());
    EXPECT_THAT(phases.ground_events.at(0).what, testing::HasSubstr("states that it is on the ground"));
}

/// Three minutes of hover within centimetres, from the log's beginning to its end.
FlightSeries still_hover() {
    FlightSeries series;
    series.firmware = "rotorcraft";
    for (const auto* name : {"altitude_m", "throttle_percent", "current_a", "power_w"}) {
        series.tracks.push_back({.name = name, .source = name});
        for (int i = 0; i < 900; ++i) series.tracks.back().time_s.push_back(0.2 * i);
    }
    for (int i = 0; i < 900; ++i) {
        series.tracks[0].value.push_back(420.0 + 0.05 * (i % 3));
        series.tracks[1].value.push_back(42.0 + i % 3);
        series.tracks[2].value.push_back(16.0 + 0.1 * (i % 3));
        series.tracks[3].value.push_back(250.0 + i % 3);
    }
    return series;
}

TEST(HoverRecord, IsThatOfADetectorWhichReportsTheAirThroughoutTheLog) {
    std::vector<double> each_s(180);
    for (std::size_t i = 0; i < each_s.size(); ++i) each_s[i] = static_cast<double>(i);
    const auto hover_of = [&](std::size_t reports, double last) {
        auto series = still_hover();
        series.tracks.push_back(state("landed", {each_s.begin(), each_s.begin() + static_cast<std::ptrdiff_t>(reports)},
                                      std::vector<double>(reports, 0.0)));
        series.tracks.back().value.back() = last;
        return segment(select_tracks(series));
    };
    const auto hover = hover_of(180, 0.0);
    ASSERT_EQ(hover.sorties.size(), 1U);
    EXPECT_NEAR(hover.sorties[0].end_s() - hover.sorties[0].start_s(), 180.0, 1.0);
    EXPECT_FALSE(hover.sorties[0].phases.at(0).complete);
    EXPECT_THAT(hover_of(180, 1.0).sorties, IsEmpty());
    EXPECT_THAT(hover_of(9, 0.0).sorties, IsEmpty()) << "changes alone state nothing of the beginning";
    EXPECT_THAT(segment(select_tracks(still_hover())).sorties, IsEmpty());
}

TEST(HoverRecord, HasNoIdleThrottleWhereItsLeastIsThatOfAFlight) {
    EXPECT_EQ(segment(select_tracks(still_hover())).motor_source, "throttle_percent");
    EXPECT_THAT(segment(select_tracks(still_hover())).warnings, IsEmpty());
}

/// Heights at times, straight lines between, four samples a second; the throttle is that of a hover from lift-off to
/// touchdown, the power, if any, is sampled at an interval.
FlightPhases flown(const Track& heights, double lift_off_s, double touchdown_s, double power_interval_s = 0.0) {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    for (double time_s = heights.time_s.front(); time_s <= heights.time_s.back(); time_s += 0.25) {
        for (auto* track : {&throttle, &altitude}) track->time_s.push_back(time_s);
        altitude.value.push_back(value_at(heights, time_s));
        throttle.value.push_back(time_s >= lift_off_s && time_s <= touchdown_s ? 50.0 + std::fmod(time_s, 1.0) : 20.0);
    }
    series.tracks = {altitude, throttle, state("armed", {0.0}, {1.0})};
    if (power_interval_s > 0.0) {
        Track power{.name = "power_w", .source = "BAT.Volt * BAT.Curr"};
        for (double time_s = altitude.time_s.front(); time_s <= altitude.time_s.back(); time_s += power_interval_s) {
            power.time_s.push_back(time_s);
            power.value.push_back(value_at(throttle, time_s) > 30.0 ? 250.0 + std::fmod(time_s, 3.0) : 25.0);
        }
        series.tracks.push_back(power);
    }
    return segment(select_tracks(series));
}

void expect_edges(const FlightPhases& phases, const std::vector<double>& expected_s) {
    ASSERT_EQ(phases.sorties.size(), 1U);
    std::vector<double> edges_s{phases.sorties[0].start_s()};
    for (const auto& span : phases.sorties[0].phases) edges_s.push_back(span.end.time_s);
    ASSERT_EQ(edges_s.size(), expected_s.size());
    for (std::size_t i = 0; i < edges_s.size(); ++i) EXPECT_NEAR(edges_s[i], expected_s[i], 1.1) << i;
}

TEST(HoverEdges, OfTakeoffAndLandingAreThoseOfFirstClimbAndLastDescent) {
    const Track steps{.time_s = {0, 20, 24, 60, 66, 90, 96, 120, 128, 140}, .value = {0, 0, 8, 8, 20, 20, 8, 8, 0, 0}};
    expect_edges(flown(steps, 20, 128), {20, 24, 120, 128});
    // A slow drift before the descent, and a short pause in it.
    const Track drifting{.time_s = {0, 20, 30, 70, 80, 86, 88, 96, 120}, .value = {0, 0, 30, 30, 27.5, 15, 15, 0, 0}};
    expect_edges(flown(drifting, 20, 96), {20, 30, 80, 96});
    const Track to_a_roof{.time_s = {0, 20, 30, 90, 100, 120}, .value = {0, 0, 30, 30, 15, 15}};
    expect_edges(flown(to_a_roof, 20, 100), {20, 30, 90, 100});
    const Track up_and_down{.time_s = {0, 20, 30, 40, 60}, .value = {0, 0, 20, 0, 0}};
    expect_edges(flown(up_and_down, 20, 40), {20, 30, 40});
}

TEST(HoverEdges, AreThoseOfTheThrottleWherePowerIsSlow) {
    // The log ends, as at disarming, before the next sample of power.
    const Track flight{.time_s = {0, 15, 25, 175, 194, 198}, .value = {0, 0, 20, 20, 0, 0}};
    for (const double interval_s : {1.0, 5.0, 10.0, 15.0}) {
        SCOPED_TRACE(interval_s);
        expect_edges(flown(flight, 15, 194, interval_s), {15, 25, 175, 194});
    }
}

TEST(HoverEdges, AreAbsentWhereTheLogBeginsOrEndsInTheAir) {
    const Track whole{.time_s = {20, 30, 60, 75}, .value = {0, 20, 20, 0}};
    const auto groundless = flown(whole, 20, 80);
    expect_edges(groundless, {20, 75});
    EXPECT_FALSE(groundless.sorties[0].phases[0].complete) << "no ground is seen";
    const Track late{.time_s = {0, 20, 30, 60, 70}, .value = {0, 0, 20, 20, 5}};
    const auto descends = flown(late, 20, 80);
    expect_edges(descends, {20, 30, 60, 70});
    EXPECT_FALSE(descends.sorties[0].phases[2].complete) << "most of the height is lost";
    const Track high{.time_s = {0, 20, 30, 60, 70}, .value = {0, 0, 20, 20, 12}};
    expect_edges(flown(high, 20, 80), {20, 30, 70});
    const Track touches{.time_s = {0, 10, 20, 40}, .value = {20, 20, 0, 0}};
    expect_edges(flown(touches, 0, 20), {0, 10, 20});
    // Armed on the ground when the log begins.
    const Track begins{.time_s = {0, 2, 12, 40, 55, 80}, .value = {0, 0, 20, 20, 0, 0}};
    expect_edges(flown(begins, 0, 55), {2, 12, 40, 55});
}

TEST(HoverRecord, IsSeparatedByALanding) {
    auto series = hopping_copter();
    series.tracks.push_back(state("landed", {19.0, 62.0, 69.0, 101.0}, {0.0, 1.0, 0.0, 1.0}));
    const auto sorties = segment(select_tracks(series)).sorties;
    ASSERT_EQ(sorties.size(), 2U);
    EXPECT_NEAR(sorties[0].end_s(), 59.5, 0.6);
    EXPECT_NEAR(sorties[1].start_s(), 70.0, 0.6);
    EXPECT_EQ(segment(select_tracks(series)).rests.size(), 3U);
}

TEST(LandDetector, ConfirmsAnEdgeIfItReportsAllTheTime) {
    Track detector = state("landed", {}, {});
    for (int i = 0; i < 20; ++i) {
        detector.time_s.push_back(i);
        detector.value.push_back(i < 5 || i > 15 ? 1.0 : 0.0);
    }
    EXPECT_EQ(confirmed_by_detector(detector, 6.5, false), 5.0);
    EXPECT_EQ(confirmed_by_detector(detector, 7.5, false), 7.5) << "too far";
    EXPECT_EQ(confirmed_by_detector(detector, 6.5, true), 6.5) << "the other turn";
    EXPECT_EQ(confirmed_by_detector(detector, 15.0, true), 16.0);
    EXPECT_EQ(confirmed_by_detector(state("landed", {5.0}, {0.0}), 6.5, false), 6.5);
}

/// A copter that hovers at 50 m from 20 to 100 s; its motors give `percent` then until the end, at heights as given.
FlightPhases after_motors_stop(const std::vector<double>& later_m, double percent = 5.0) {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    const auto add = [&](double height_m, double throttle_percent) {
        for (auto* track : {&throttle, &altitude})
            track->time_s.push_back(0.5 * static_cast<double>(track->value.size()));
        altitude.value.push_back(height_m);
        throttle.value.push_back(throttle_percent);
    };
    for (double t = 0.0; t < 100.0; t += 0.5) add(std::clamp(5.0 * (t - 20.0), 0.0, 50.0), t < 20.0 ? 5.0 : 50.0);
    for (const double height_m : later_m) add(height_m, percent);
    series.tracks = {altitude, throttle, state("armed", {0.0}, {1.0})};
    return segment(select_tracks(series));
}

/// Heights each half second of a fall from 50 m.
std::vector<double> fall_to(double ground_m, double still_s) {
    std::vector<double> heights_m;
    for (double t = 0.5; 50.0 - 4.9 * t * t > ground_m; t += 0.5) heights_m.push_back(50.0 - 4.9 * t * t);
    heights_m.insert(heights_m.end(), static_cast<std::size_t>(2.0 * still_s), ground_m);
    return heights_m;
}

TEST(HoverRecord, AFallAfterTheMotorsStoppedBelongsToTheFlight) {
    const auto phases = after_motors_stop(fall_to(0.0, 20.0));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].start_s(), 20.0, 1.5);
    EXPECT_NEAR(phases.sorties[0].end_s(), 103.0, 1.5);
    EXPECT_TRUE(phases.sorties[0].phases.back().complete);
}

TEST(HoverRecord, ALogThatEndsInAFallHasNoGroundAtItsEnd) {
    const auto phases = after_motors_stop(fall_to(25.0, 0.0));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].ground_altitude_m, 0.0, 0.1) << "that before the flight";
    EXPECT_NEAR(phases.sorties[0].start_s(), 20.0, 1.5);
    EXPECT_FALSE(phases.sorties[0].phases.back().complete);
}

TEST(HoverRecord, APauseWithIdleMotorsOnBothSidesPartsFlightsWhateverTheArmingStates) {
    const auto sorties_with = [](double pause_s, double idle_s) {
        auto series = hopping_copter();
        series.tracks.push_back(state("armed", {5.0}, {1.0}));
        for (auto& track : series.tracks)
            if (track.name != "armed")
                for (auto& t : track.time_s)
                    if (t > 60.0 + idle_s) t += pause_s;
        return segment(select_tracks(series)).sorties.size();
    };
    EXPECT_EQ(sorties_with(8.0, 4.0), 2U);
    EXPECT_EQ(sorties_with(0.0, 4.0), 1U) << "armed throughout, as if it descended";
}

/// A copter that takes off at 20 s and lands at 200 s from 40 m, and again 100 s later; its motors give the throttle of
/// `percent_at` in the air and 5 % on the ground.
template <typename PercentAt>
FlightPhases two_flights(const PercentAt& percent_at) {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    for (double time_s = 0.0; time_s < 540.0; time_s += 0.5) {
        const double own_s = std::fmod(time_s, 270.0);
        const bool flies = own_s >= 20.0 && own_s < 200.0;
        for (auto* track : {&throttle, &altitude}) track->time_s.push_back(time_s);
        altitude.value.push_back(!flies ? 0.0 : std::min({4.0 * (own_s - 20.0), 40.0, 2.0 * (200.0 - own_s)}));
        throttle.value.push_back(flies ? percent_at(time_s) + std::fmod(time_s, 1.0) : 5.0);
    }
    series.tracks = {altitude, throttle, state("armed", {15.0, 205.0, 285.0, 475.0}, {1.0, 0.0, 1.0, 0.0})};
    return segment(select_tracks(series));
}

/// The flight without the payload was lost, or ended "in the air" after its climb.
TEST(HoverRecord, AFlightWithoutThePayloadOfAnotherIsWhole) {
    for (const double empty_percent : {48.0, 40.0, 34.0}) {
        SCOPED_TRACE(empty_percent);
        for (const bool is_first : {true, false}) {
            const auto phases =
                two_flights([&](double time_s) { return (time_s < 270.0) == is_first ? empty_percent : 72.0; });
            ASSERT_EQ(phases.sorties.size(), 2U);
            for (const auto& sortie : phases.sorties) {
                ASSERT_EQ(sortie.phases.size(), 3U);
                EXPECT_NEAR(sortie.end_s() - sortie.start_s(), 180.0, 2.0);
                EXPECT_TRUE(sortie.phases.back().complete);
            }
        }
    }
}

TEST(HoverRecord, AFlightThatDropsItsPayloadLandsOnTheGround) {
    const auto phases = two_flights([](double time_s) { return std::fmod(time_s, 270.0) < 140.0 ? 72.0 : 38.0; });
    ASSERT_EQ(phases.sorties.size(), 2U);
    for (const auto& sortie : phases.sorties) {
        EXPECT_NEAR(sortie.end_s() - sortie.start_s(), 180.0, 2.0);
        EXPECT_TRUE(sortie.phases.back().complete);
        EXPECT_NEAR(sortie.ground_altitude_m, 0.0, 0.1);
    }
}

TEST(HoverRecord, MotorsThatIdleAtMuchThrottleDoNotFlyWhileTheAltitudeWanders) {
    FlightSeries series;
    series.firmware = "rotorcraft";
    Track throttle{.name = "throttle_percent", .source = "CTUN.ThO"};
    Track altitude{.name = "altitude_m", .source = "BARO.Alt"};
    for (double time_s = 0.0; time_s < 400.0; time_s += 0.5) {
        const bool flies = time_s >= 20.0 && time_s < 100.0;
        for (auto* track : {&throttle, &altitude}) track->time_s.push_back(time_s);
        altitude.value.push_back(flies ? std::min({2.0 * (time_s - 20.0), 20.0, 2.0 * (100.0 - time_s)})
                                       : 0.02 * std::max(time_s - 100.0, 0.0));
        throttle.value.push_back((flies ? 50.0 : 20.0) + std::fmod(time_s, 1.0));
    }
    series.tracks = {altitude, throttle, state("armed", {0.0}, {1.0})};
    const auto phases = segment(select_tracks(series));
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_NEAR(phases.sorties[0].end_s(), 100.0, 1.5);
}

}  // namespace
}  // namespace flightwatt::flight
