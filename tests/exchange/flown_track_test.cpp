#include "exchange/flown_track.h"

#include "base/error.h"
#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::exchange {
namespace {

using flight::FlightPhases;
using flight::Phase;

/// Five places a second apart, with power 0, 10, ... 40 W and altitude.
flight::FlightSeries places(std::vector<double> longitudes = {1.0, 1.1, 1.2, 1.3, 1.4}) {
    flight::FlightSeries series;
    series.file = "made.csv";
    series.flight = "made";
    const std::vector<double> times{0.0, 1.0, 2.0, 3.0, 4.0};
    const auto add = [&](const char* name, std::vector<double> values) {
        series.tracks.push_back({.name = name, .source = "made", .time_s = times, .value = std::move(values)});
    };
    add("altitude_m", {100.0, 110.0, 120.0, 130.0, 140.0});
    series.tracks.back().source = "series CSV";
    add("power_w", {0.0, 10.0, 20.0, 30.0, 40.0});
    add("latitude_deg", {40.0, 40.1, 40.2, 40.3, 40.4});
    add("longitude_deg", std::move(longitudes));
    return series;
}

flight::PhaseSpan span(Phase phase, double start_s, double end_s) {
    flight::PhaseSpan result;
    result.phase = phase;
    result.start.time_s = start_s;
    result.end.time_s = end_s;
    return result;
}

/// A take-off from 1 to 2 s, and a cruise from there to 4 s.
FlightPhases two_phases() {
    flight::Sortie sortie;
    sortie.phases = {span(Phase::takeoff, 1.0, 2.0), span(Phase::cruise, 2.0, 4.0)};
    FlightPhases phases;
    phases.sorties.push_back(sortie);
    return phases;
}

std::string rejection_of(const flight::FlightSeries& series) {
    try {
        flown_track(select_tracks(series), {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FlownTrack, HasEachPositionWithAltitudePowerAndPhase) {
    const auto track = flown_track(select_tracks(places()), two_phases());
    ASSERT_EQ(track.points.size(), 5U);
    const auto& point = track.points[2];
    EXPECT_DOUBLE_EQ(point.longitude_deg, 1.2);
    EXPECT_DOUBLE_EQ(point.latitude_deg, 40.2);
    EXPECT_DOUBLE_EQ(point.altitude_m.value(), 120.0);
    EXPECT_DOUBLE_EQ(point.power_w.value(), 20.0);
    EXPECT_EQ(point.phase, Phase::cruise);
    EXPECT_FALSE(track.points[0].phase);
    EXPECT_FALSE(track.points[4].phase) << "a phase ends where it ends";
    EXPECT_EQ(track.clock, TrackClock::none);
}

TEST(FlownTrack, TakesTheLogsClockBeforeThatOfItsName) {
    auto series = places();
    series.flight = "20_07_05__10_26_44";
    auto track = flown_track(select_tracks(series), {});
    EXPECT_EQ(track.clock, TrackClock::name);
    EXPECT_EQ(utc_text(track, 1.5), "2020-07-05T10:26:45.500Z");
    series.start_clock_s = 1593937604.26;
    track = flown_track(select_tracks(series), {});
    EXPECT_EQ(track.clock, TrackClock::log);
    EXPECT_EQ(utc_text(track, 0.0), "2020-07-05T08:26:44.260Z");
    EXPECT_EQ(utc_text(track, 0.7399), "2020-07-05T08:26:45.000Z") << "rounded, not cut";
}

/// The places with an altitude above the ground.
flight::FlightSeries places_above_ground(const char* source) {
    auto series = places();
    auto& altitude = series.tracks.front();
    altitude.source = source;
    altitude.value = {0.0, 10.0, 20.0, 30.0, 40.0};
    return series;
}

TEST(FlownTrack, IsAboveTheSeaByTheReceiversAltitudeWhereItIsABarometers) {
    auto series = places_above_ground("BARO.Alt");
    auto receivers = series.tracks.front();
    receivers.source = "GPS.Alt";
    receivers.value = {250.0, 311.0, 320.0, 328.0, 339.0};  // it settles on the ground
    series.tracks.push_back(receivers);
    const auto data = select_tracks(series);
    ASSERT_EQ(data.altitude_m.source, "BARO.Alt") << "the phases are those of the barometer";
    const auto track = flown_track(data, two_phases());
    EXPECT_EQ(track.level, AltitudeLevel::sea);
    EXPECT_DOUBLE_EQ(track.points[0].altitude_m.value(), 300.0);
    EXPECT_DOUBLE_EQ(track.points[4].altitude_m.value(), 340.0);
    EXPECT_THAT(to_kml(track), testing::HasSubstr("<altitudeMode>absolute</altitudeMode>"));
    EXPECT_THAT(to_geojson(track), testing::Not(testing::HasSubstr("altitudeMode")));
}

TEST(FlownTrack, IsAboveTheTakeOffWhereNothingIsAboveTheSea) {
    auto series = places_above_ground("vehicle_local_position.z");
    auto constant = series.tracks.front();
    constant.source = "vehicle_gps_position.alt";
    constant.value = {0.0, 0.0, 0.0, 0.0, 0.0};
    series.tracks.push_back(constant);
    auto phases = two_phases();
    phases.sorties.front().ground_altitude_m = 10.0;
    const auto track = flown_track(select_tracks(series), phases);
    EXPECT_EQ(track.level, AltitudeLevel::takeoff);
    EXPECT_DOUBLE_EQ(track.points[2].altitude_m.value(), 10.0);
    EXPECT_THAT(to_kml(track), testing::HasSubstr("<altitudeMode>relativeToGround</altitudeMode>"));
    EXPECT_THAT(to_geojson(track), testing::HasSubstr(R"("altitudeMode":"relativeToGround")"));
    EXPECT_DOUBLE_EQ(flown_track(select_tracks(series), {}).points[2].altitude_m.value(), 20.0);
}

TEST(FlownTrack, HasTheAltitudeOfTheLogWhereItIsAboveTheSea) {
    for (const auto* source : {"ESTIMATOR.z", "GPS[1].Alt", "POS.Alt", "GPS_RAW_INT.alt", "series CSV"}) {
        const auto track = flown_track(select_tracks(places_above_ground(source)), two_phases());
        EXPECT_EQ(track.level, AltitudeLevel::sea) << source;
        EXPECT_DOUBLE_EQ(track.points[2].altitude_m.value(), 20.0) << source;
    }
}

TEST(FlownTrack, IsThatBetweenTheSortiesThatAreLeftOut) {
    auto phases = two_phases();
    phases.part = {0.5, 3.0};
    const auto track = flown_track(select_tracks(places()), phases);
    ASSERT_EQ(track.points.size(), 3U);
    EXPECT_EQ(track.points.front().time_s, 1.0);
    EXPECT_EQ(track.points.back().time_s, 3.0);
    phases.part = {5.0, 6.0};
    EXPECT_THROW(flown_track(select_tracks(places()), phases), InputError);
}

TEST(FlownTrack, RefusesALogWithoutPositionsAndSaysWhy) {
    auto series = places();
    series.tracks.resize(2);
    EXPECT_THAT(rejection_of(series), testing::HasSubstr("has no positions"));
    auto metres = series.tracks[0];
    metres.name = "east_m";
    series.tracks.push_back(metres);
    EXPECT_THAT(rejection_of(series), testing::HasSubstr("only in metres"));
}

TEST(ColouredParts, FollowThePhasesAndShareTheirEnds) {
    const auto parts = phase_segments(flown_track(select_tracks(places()), two_phases()));
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].name, "ground");
    EXPECT_EQ(parts[1].name, "takeoff");
    EXPECT_EQ(parts[2].name, "cruise");
    EXPECT_EQ(parts[0].last, parts[1].first);
    EXPECT_EQ(parts[1].last, parts[2].first);
    EXPECT_EQ(parts[2].last, 4U);
    EXPECT_DOUBLE_EQ(parts[2].mean_power_w.value(), 30.0);
    EXPECT_NE(parts[0].colour, parts[1].colour);
}

TEST(ColouredParts, HaveTheirMeanPowerOverTime) {
    FlownTrack track;
    // 10 W for a second, then up to 30 W in nine, at positions that come unevenly.
    for (const auto& [time_s, power_w] : {std::pair{0.0, 10.0}, {0.5, 10.0}, {1.0, 10.0}, {10.0, 30.0}}) {
        TrackPoint point{time_s, 0.0, 0.0};
        point.power_w = power_w;
        track.points.push_back(point);
    }
    const auto parts = phase_segments(track);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_DOUBLE_EQ(parts[0].mean_power_w.value(), (10.0 * 1.0 + 20.0 * 9.0) / 10.0);
}

TEST(ColouredParts, DoNotCrossTheMeridianOf180Degrees) {
    const auto parts = phase_segments(flown_track(select_tracks(places({179.8, 179.9, -179.9, -179.8, -179.7})), {}));
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].last, 1U);
    EXPECT_EQ(parts[1].first, 2U);
}

TEST(FlownTrack, CoversARealLog) {
    FLIGHTWATT_NEEDS_SHARED();
    flight::LoadOptions options;
    options.power_required = false;
    const auto loaded = flight::load_flight(test::shared_dir() / "flights" / "20_07_03__12_17_45.data", options);
    const auto track = flown_track(loaded.data, loaded.phases);
    EXPECT_EQ(track.clock, TrackClock::log);
    EXPECT_GT(track.points.size(), 1000U);
    for (const auto& point : track.points) {
        EXPECT_NEAR(point.latitude_deg, 43.46, 0.2);
        EXPECT_NEAR(point.longitude_deg, 1.27, 0.2);
    }
    EXPECT_GE(phase_segments(track).size(), 4U);
}

}  // namespace
}  // namespace flightwatt::exchange
