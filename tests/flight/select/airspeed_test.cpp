#include "flight/select/airspeed.h"

#include "base/units.h"
#include "flight/load_flight.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A wing of 12 m/s that waits for a minute, flies and waits; its airspeed wanders by `wander_m_per_s`.
struct Wing {
    double duration_s = 600.0;
    double wander_m_per_s = 0.0;
    unsigned seed = 1;
    std::function<double(double)> heading_deg = [](double t) { return 8.0 * t; };
    std::function<double(double)> wind_east = [](double) { return 4.0; };
    double wind_north = -3.0;
};

FlightSeries series_of(const Wing& wing) {
    FlightSeries series;
    series.flight = "wing";
    series.firmware = "fixedwing";
    Track altitude{"altitude_m", "GPS.alt"};
    Track speed{"ground_speed_m_per_s", "GPS.speed"};
    Track course{"course_deg", "GPS.course"};
    std::mt19937 random(wing.seed);
    std::normal_distribution<double> normal;
    double off = normal(random);
    const double waits_s = 60.0;
    for (double t = 0.0; t <= wing.duration_s + 2.0 * waits_s; t += 1.0) {
        const double flown_s = t - waits_s;
        const bool flies = flown_s >= 0.0 && flown_s <= wing.duration_s;
        const double heading = wing.heading_deg(flown_s) / units::degree_per_rad;
        const double airspeed = 12.0 + wing.wander_m_per_s * off;
        const double east = airspeed * std::sin(heading) + wing.wind_east(flown_s);
        const double north = airspeed * std::cos(heading) + wing.wind_north;
        const double course_deg = std::atan2(east, north) * units::degree_per_rad;
        for (auto* track : {&altitude, &speed, &course}) track->time_s.push_back(t);
        altitude.value.push_back(flies ? 80.0 : 0.0);
        speed.value.push_back(flies ? std::hypot(east, north) : 0.2);
        course.value.push_back(flies ? std::fmod(course_deg + 360.0, 360.0) : 77.0);
        off = 0.9 * off + std::sqrt(1.0 - 0.81) * normal(random);
    }
    series.tracks = {altitude, speed, course};
    return series;
}

double bearing_of_leg(double t, std::initializer_list<double> bearings_deg) {
    const auto leg = static_cast<std::size_t>(std::max(t, 0.0) / 60.0);
    return bearings_deg.begin()[leg % bearings_deg.size()];
}

std::string reason_against(const Wing& wing) {
    const auto data = select_tracks(series_of(wing));
    EXPECT_TRUE(data.airspeed_m_per_s.empty());
    EXPECT_FALSE(data.airspeed_estimate);
    return data.airspeed_m_per_s.not_chosen.empty() ? "" : data.airspeed_m_per_s.not_chosen.front();
}

TEST(EstimatedAirspeed, IsTheGroundVelocityLessTheWindOfCircles) {
    const auto data = select_tracks(series_of({}));
    ASSERT_TRUE(data.airspeed_estimate);
    ASSERT_EQ(data.airspeed_estimate->winds.size(), 1u);
    EXPECT_NEAR(data.airspeed_estimate->winds[0].east_m_per_s, 4.0, 0.02);
    EXPECT_NEAR(data.airspeed_estimate->winds[0].north_m_per_s, -3.0, 0.02);
    EXPECT_NEAR(value_at(data.airspeed_m_per_s, 333.0), 12.0, 0.05);
    EXPECT_GE(data.airspeed_m_per_s.time_s.front(), 60.0) << "not on the ground";
    EXPECT_LE(data.airspeed_m_per_s.time_s.back(), 660.0);
    EXPECT_FALSE(data.airspeed_is_measured());
    EXPECT_NEAR(value_at(data.wind_east_m_per_s, 333.0), 4.0, 0.02);
    // Half of a circle or more averages to no error along the heading; gusts of 0.6 m/s are assumed.
    EXPECT_NEAR(data.airspeed_estimate->sd_m_per_s, 0.65, 0.05);
    EXPECT_LT(data.airspeed_estimate->mean_sd_m_per_s, 0.2);
    EXPECT_THAT(
        texts_of(selection_diagnostics(data)),
        Contains(HasSubstr("the airspeed is estimated within 0.7 m/s (1 sd, means over 30 s) from GPS.speed and "
                           "course: wind 5.0 m/s from 307 degrees (within 0.4 m/s)")));
}

TEST(EstimatedAirspeed, IsKnownByThreeLegs) {
    const auto legs = [](double t) { return bearing_of_leg(t, {10.0, 130.0, 250.0}); };
    const auto data = select_tracks(series_of({.wander_m_per_s = 0.3, .heading_deg = legs}));
    ASSERT_TRUE(data.airspeed_estimate);
    EXPECT_NEAR(data.airspeed_estimate->winds[0].east_m_per_s, 4.0, 0.4);
    EXPECT_NEAR(data.airspeed_estimate->winds[0].north_m_per_s, -3.0, 0.4);
}

TEST(EstimatedAirspeed, IsUnknownWhereTheHeadingsDoNotShowTheWind) {
    const auto to_and_fro = [](double t) { return bearing_of_leg(t, {70.0, 250.0}); };
    EXPECT_THAT(reason_against({.heading_deg = to_and_fro}), HasSubstr("circles or legs in three directions"));
    EXPECT_THAT(reason_against({.wander_m_per_s = 0.2, .heading_deg = [](double t) { return 0.1 * t; }}),
                HasSubstr("no heading within"));
    EXPECT_THAT(reason_against({.duration_s = 240.0, .wander_m_per_s = 5.0}),
                HasSubstr("the wind is only known within"));
    EXPECT_THAT(reason_against({.duration_s = 170.0}), HasSubstr("180 s are needed"));
    EXPECT_TRUE(select_tracks(series_of({.duration_s = 185.0, .wander_m_per_s = 0.2})).airspeed_estimate);
}

TEST(EstimatedAirspeed, IsOfWingsWithoutASensorAlone) {
    auto series = series_of({});
    for (const auto* kind : {"rotorcraft", "rover", ""}) {
        series.firmware = kind;
        EXPECT_TRUE(select_tracks(series).airspeed_m_per_s.empty()) << kind;
    }
    series.firmware = "fixedwing";
    series.tracks.push_back({.name = "airspeed_m_per_s", .source = "AIRSPEED.airspeed"});
    series.tracks.back().time_s = {0.0, 1.0};
    series.tracks.back().value = {11.0, 12.0};
    EXPECT_EQ(select_tracks(series).airspeed_m_per_s.source, "AIRSPEED.airspeed");
    EXPECT_TRUE(select_tracks(series).airspeed_is_measured());
    series.tracks.back().value = {12.0, 12.0};  // no sensor
    EXPECT_TRUE(select_tracks(series).airspeed_estimate);
}

/// The wing with a sensor that reads a multiple of its airspeed, and the wind that its autopilot derives from it.
FlightSeries with_sensor(double multiple, const Wing& wing = {}) {
    auto series = series_of(wing);
    for (const auto* name : {"airspeed_m_per_s", "wind_east_m_per_s"}) {
        series.tracks.push_back({.name = name, .source = "ARSP.Airspeed"});
        for (double t = 0.0; t <= wing.duration_s + 120.0; t += 1.0) {
            series.tracks.back().time_s.push_back(t);
            series.tracks.back().value.push_back(12.0 * multiple + 0.2 * std::sin(t));
        }
    }
    return series;
}

TEST(EstimatedAirspeed, ReplacesASensorThatTheGroundVelocityDisproves) {
    const auto wrong = select_tracks(with_sensor(1.5));
    ASSERT_TRUE(wrong.airspeed_estimate);
    EXPECT_FALSE(wrong.airspeed_is_measured());
    EXPECT_NEAR(value_at(wrong.airspeed_m_per_s, 333.0), 12.0, 0.05);
    EXPECT_NEAR(value_at(wrong.wind_east_m_per_s, 333.0), 4.0, 0.02) << "not the wind of the sensor";
    const auto found = selection_diagnostics(wrong);
    const auto warned = std::ranges::find(found, "wrong airspeed sensor", &Diagnostic::kind);
    ASSERT_NE(warned, found.end());
    EXPECT_EQ(warned->severity, Severity::warning);
    EXPECT_THAT(texts_of({*warned}),
                Contains(HasSubstr("the sensor (ARSP.Airspeed) reads 18.0 m/s on average where the "
                                   "velocity over ground on all headings shows 12.0 m/s")));
    const auto is_used = [](double multiple) { return select_tracks(with_sensor(multiple)).airspeed_is_measured(); };
    EXPECT_TRUE(is_used(0.76));
    EXPECT_FALSE(is_used(0.74));
    EXPECT_TRUE(is_used(1.24));
    EXPECT_FALSE(is_used(1.26));
}

TEST(EstimatedAirspeed, DisprovesNoSensorWithoutHeadingsOrAWing) {
    const auto to_and_fro = [](double t) { return bearing_of_leg(t, {70.0, 250.0}); };
    const auto unseen = select_tracks(with_sensor(1.5, {.heading_deg = to_and_fro}));
    EXPECT_TRUE(unseen.airspeed_is_measured());
    EXPECT_TRUE(unseen.airspeed_m_per_s.not_chosen.empty());
    auto series = with_sensor(1.5);
    series.firmware = "rotorcraft";
    EXPECT_TRUE(select_tracks(series).airspeed_is_measured());
}

TEST(EstimatedAirspeed, FollowsAWindThatChanges) {
    const auto data = select_tracks(series_of({.duration_s = 1800.0, .wind_east = [](double t) {
                                                   return t < 600.0 ? 2.0 : t < 1200.0 ? 4.0 : 6.0;
                                               }}));
    ASSERT_TRUE(data.airspeed_estimate);
    const auto& winds = data.airspeed_estimate->winds;
    ASSERT_EQ(winds.size(), 3u);
    for (std::size_t i = 0; i < winds.size(); ++i)
        EXPECT_NEAR(winds[i].east_m_per_s, 2.0 + 2.0 * static_cast<double>(i), 0.1);
    // Fewer winds where a part does not show its own: the first ten minutes are straight.
    const auto straight_first = [](double t) { return t < 600.0 ? 40.0 : 8.0 * t; };
    const auto of_all = select_tracks(series_of({.duration_s = 1800.0, .heading_deg = straight_first}));
    ASSERT_TRUE(of_all.airspeed_estimate);
    EXPECT_EQ(of_all.airspeed_estimate->winds.size(), 2u);
}

TEST(EstimatedAirspeed, KeepsALoggedWind) {
    auto series = series_of({});
    for (const auto* name : {"wind_east_m_per_s", "wind_north_m_per_s"}) {
        series.tracks.push_back({.name = name, .source = "WIND_INFO"});
        series.tracks.back().time_s = {0.0, 1.0};
        series.tracks.back().value = {1.0, 2.0};
    }
    EXPECT_EQ(select_tracks(series).wind_east_m_per_s.source, "WIND_INFO");
}

TEST(EstimatedAirspeed, KnowsNothingLater) {
    const auto series = series_of({.duration_s = 1300.0, .wander_m_per_s = 0.5});
    const auto cut = truncate_series(series, 400.0);
    auto shorter = series;
    for (auto& track : shorter.tracks) {
        track.time_s.resize(401);
        track.value.resize(401);
    }
    EXPECT_EQ(select_tracks(cut).airspeed_m_per_s.value, select_tracks(shorter).airspeed_m_per_s.value);
    EXPECT_LE(select_tracks(cut).airspeed_m_per_s.time_s.back(), 400.0);
}

/// Wind and mean airspeed of a real flight whose sensor is hidden; the wind is that which fits its sensor best.
TEST(EstimatedAirspeed, IsNearTheSensorOfARealFlight) {
    FLIGHTWATT_NEEDS_SHARED();
    auto series = read_flight(test::shared_dir() / "archives" / "mit" / "flight3.ulg");
    const auto measured = select_tracks(series).airspeed_m_per_s;
    std::erase_if(series.tracks, [](const Track& track) { return track.name == "airspeed_m_per_s"; });
    const auto data = select_tracks(series);
    ASSERT_TRUE(data.airspeed_estimate);
    const auto& wind = data.airspeed_estimate->winds.front();
    EXPECT_NEAR(wind.east_m_per_s, -4.2, 0.5);
    EXPECT_NEAR(wind.north_m_per_s, 0.4, 0.5);
    const auto mean_of = [](const Track& track) {
        return integrated(track.time_s, track.value, 1145.0, 1355.0) / 210.0;
    };
    EXPECT_NEAR(mean_of(data.airspeed_m_per_s), mean_of(measured), 0.6);
}

/// Winds whose error is within 1.96 standard deviations, of flights whose airspeed wanders by 1 m/s.
double share_held(const std::function<double(double)>& heading_deg) {
    constexpr unsigned flights = 150;
    double held = 0.0;
    for (unsigned seed = 1; seed <= flights; ++seed) {
        const auto data = select_tracks(
            series_of({.duration_s = 400.0, .wander_m_per_s = 1.0, .seed = seed, .heading_deg = heading_deg}));
        if (!data.airspeed_estimate) {
            ADD_FAILURE() << "no estimate with seed " << seed;
            continue;
        }
        const auto& wind = data.airspeed_estimate->winds.front();
        held += std::abs(wind.east_m_per_s - 4.0) < 1.96 * std::sqrt(wind.east_variance) ? 0.5 : 0.0;
        held += std::abs(wind.north_m_per_s + 3.0) < 1.96 * std::sqrt(wind.north_variance) ? 0.5 : 0.0;
    }
    return held / flights;
}

TEST(EstimatedAirspeed, StatesItsError) {
    EXPECT_GE(share_held([](double t) { return 8.0 * t; }), 0.95);
    EXPECT_GE(share_held([](double t) { return bearing_of_leg(t, {0.0, 90.0, 180.0, 270.0}); }), 0.93);
}

}  // namespace
}  // namespace flightwatt::flight
