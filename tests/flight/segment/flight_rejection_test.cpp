#include "flight/segment/flight_rejection.h"

#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "helpers/flown_points.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using test::columns_of;
using test::sortie;
using testing::HasSubstr;

std::string why_none(const FlightSeries& series) {
    const auto phases = segment(select_tracks(series));
    if (!phases.sorties.empty()) return fmt::format("{} sorties", phases.sorties.size());
    return phases.ground_events.empty() ? "nothing seen" : phases.ground_events.front().what;
}

TEST(FlightRejection, OfASenderOfRoverStatus) {
    auto series = test::series_of(columns_of(sortie(100)));
    EXPECT_EQ(why_none(series), "1 sorties");
    series.tracks.push_back({.name = "rover_mode", .source = "ROVER_STATUS.ap_mode", .time_s = {80}, .value = {2}});
    EXPECT_EQ(why_none(series), "a ground vehicle: it sends ROVER_STATUS");
    EXPECT_EQ(why_none(parse_series_csv(to_csv(series), "x.csv")), "a ground vehicle: it sends ROVER_STATUS");
    EXPECT_EQ(why_none(truncate_series(series, 79.0)).find("ground vehicle"), std::string::npos) << "no hindsight";
}

TEST(FlightRejection, OfAnAirframeWithTheFirmwareOfRovers) {
    auto series = test::series_of(columns_of(sortie(100)));
    series.firmware = "rover";
    EXPECT_EQ(why_none(series), "a ground vehicle: its airframe's firmware is rover");
    EXPECT_EQ(why_none(parse_series_csv(to_csv(series), "x.csv")), why_none(series));
    series.firmware = "rotorcraft";
    EXPECT_EQ(why_none(series), "1 sorties");
}

TEST(FlightRejection, WhereAnotherAltitudeSaysThatNothingMoved) {
    auto series = test::series_of(columns_of(sortie(100)));
    auto gps = select_track(series, "altitude_m");
    gps.source = "GPS.alt";
    for (std::size_t i = 0; i < gps.value.size(); ++i) gps.value[i] = 600.0 + 0.5 * static_cast<double>(i % 5);
    series.tracks.push_back(gps);
    EXPECT_THAT(why_none(series), HasSubstr("series CSV changes by 74 m, GPS.alt by 2.0 m: its estimator diverged"));
    // A third altitude that moves as well confirms the first.
    auto confirmed = series;
    confirmed.tracks.push_back(select_track(series, "altitude_m"));
    confirmed.tracks.back().source = "AIR_DATA.amsl_baro";
    EXPECT_EQ(why_none(confirmed), "1 sorties");
    // Without a fix it repeats one value, which states nothing, and a barometer alone may be broken.
    auto broken = series;
    broken.tracks.back().source = "AIR_DATA.amsl_baro";
    EXPECT_EQ(why_none(broken), "1 sorties");
    series.tracks.back().value.assign(gps.value.size(), 0.0);
    series.tracks.back().value.front() = 2.0;
    EXPECT_EQ(why_none(series), "1 sorties");
}

TEST(FlightRejection, WhereTheAltitudeChangesFasterThanAircraftClimb) {
    auto columns = columns_of(sortie(100));
    for (auto& altitude_m : columns.altitude_m) altitude_m *= 15.0;
    for (auto& altitude_m : columns.altitude_m) altitude_m += 0.1;
    EXPECT_THAT(why_none(test::series_of(columns)), HasSubstr("m/s for 30 s: its estimator diverged"));
}

TEST(FlightRejection, WhereItDrivesAtOneHeightAndTheGroundIsNotSeen) {
    std::vector<test::Point> points;
    for (int i = 0; i < 20; ++i) {
        const double altitude_m = 650.0 + 4.0 * (i % 3);
        points.push_back({20.0 * i, altitude_m, 60});
        points.push_back({20.0 * i + 10.0, altitude_m, 60});
        points.push_back({20.0 * i + 11.0, altitude_m, 10});
        points.push_back({20.0 * i + 12.0, altitude_m, 60});
    }
    auto columns = columns_of(points);
    columns.ground_speed_m_per_s.assign(columns.time_s.size(), 1.9);
    auto series = test::series_of(columns);
    series.planned_ground_altitude_m = 600.0;
    for (auto& track : series.tracks) {
        if (track.name == "altitude_m") track.source = "GPS.alt";
    }
    EXPECT_THAT(why_none(series), HasSubstr("driven or carried"));
    // A rotorcraft may hover there, and what no one clocked may fly.
    auto hovering = series;
    for (auto& track : hovering.tracks) {
        if (track.name != "altitude_m") continue;
        track.source = "ROTORCRAFT_FP.up";
        for (auto& value : track.value) value -= 600.0;
    }
    EXPECT_EQ(why_none(hovering), "1 sorties");
    std::erase_if(series.tracks, [](const Track& track) { return track.name == "ground_speed_m_per_s"; });
    EXPECT_EQ(why_none(series), "1 sorties");
}

/// A wing at one height for its whole log.
struct LevelWing {
    double duration_s = 62.0;
    double speed_m_per_s = 15.0;
    double throttle_percent = 45.0;
    double motion_m = 4.0;
    const char* firmware = "fixedwing";
};

FlightSeries series_of(const LevelWing& wing) {
    auto columns = columns_of({{0, 80, 0}, {wing.duration_s, 80, 0}}, 1.0);
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        columns.throttle_percent[i] = wing.throttle_percent + 0.1 * static_cast<double>(i % 3);
        columns.power_w[i] = 100.0 + static_cast<double>(i % 3);
        columns.altitude_m[i] += wing.motion_m * std::sin(columns.time_s[i]);
    }
    columns.ground_speed_m_per_s.assign(columns.time_s.size(), wing.speed_m_per_s);
    auto series = test::series_of(columns);
    series.firmware = wing.firmware;
    return series;
}

TEST(FlightRejection, IsNoneOfALogThatBeginsAndEndsInCruise) {
    for (const double motion_m : {4.0, 0.0}) {
        const auto phases = segment(select_tracks(series_of(LevelWing{.motion_m = motion_m})));
        ASSERT_EQ(phases.sorties.size(), 1U);
        ASSERT_EQ(phases.sorties[0].phases.size(), 1U);
        EXPECT_EQ(phases.sorties[0].phases[0].phase, Phase::cruise);
        EXPECT_FALSE(phases.sorties[0].phases[0].complete);
        EXPECT_NEAR(phases.sorties[0].phases[0].duration_s(), 62.0, 1.0);
    }
    const auto taxis = HasSubstr("run-up, taxi or hop");
    EXPECT_THAT(why_none(series_of(LevelWing{.duration_s = 57.0})), taxis);
    EXPECT_THAT(why_none(series_of(LevelWing{.speed_m_per_s = 4.9})), taxis);
    EXPECT_THAT(why_none(series_of(LevelWing{.throttle_percent = 19.0})), taxis);
    EXPECT_THAT(why_none(series_of(LevelWing{.firmware = ""})), taxis);
}

TEST(FlightRejection, WhereAnAltitudeAloneIsThatOfAnEstimatorThatSettles) {
    const auto alone = [](const std::vector<test::Point>& points, double speed_m_per_s) {
        auto columns = columns_of(points);
        columns.throttle_percent.clear();
        columns.power_w.assign(columns.time_s.size(), 12.0);
        if (speed_m_per_s >= 0.0) columns.ground_speed_m_per_s.assign(columns.time_s.size(), speed_m_per_s);
        return test::series_of(columns);
    };
    // It begins at one height and runs to another, which it never held.
    const std::vector<test::Point> begins_wrong{{0, 40, 0}, {2, 40, 0}, {9, 0, 0}, {300, 0, 0}};
    EXPECT_THAT(why_none(alone(begins_wrong, -1.0)), HasSubstr("its estimator converged"));
    const std::vector<test::Point> wanders{{0, 0, 0}, {40, 0, 0}, {60, 14, 0}, {90, 14, 0}, {110, 0, 0}, {300, 0, 0}};
    EXPECT_THAT(why_none(alone(wanders, -1.0)), HasSubstr("height of 14 m: its estimator converged"));
    EXPECT_EQ(why_none(alone(wanders, 9.0)), "1 sorties");
    EXPECT_THAT(why_none(alone(sortie(100), 4.5)), HasSubstr("at 4.5 m/s over ground: its estimator converged"));
    EXPECT_EQ(why_none(alone(sortie(100), -1.0)), "1 sorties");
    EXPECT_EQ(why_none(alone(sortie(100), 12.0)), "1 sorties");
}

TEST(FlightRejection, OfWhatMovesAsRoadsDo) {
    auto columns = columns_of({{0, 200, 0}, {50, 200, 0}, {51, 200, 40}, {750, 200, 40}, {751, 200, 0}, {800, 200, 0}});
    columns.ground_speed_m_per_s.assign(columns.time_s.size(), 0.0);
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        const double t = columns.time_s[i];
        if (t < 50 || t > 750) continue;
        columns.ground_speed_m_per_s[i] = 14.0;
        columns.altitude_m[i] += 40.0 * std::abs(std::sin((t - 50.0) / 222.8));
    }
    EXPECT_THAT(why_none(test::series_of(columns)), HasSubstr("never changes by more than 3 % of the distance"));
    // What rises up from the ground flies, however slow or low it is.
    for (const double speed_m_per_s : {0.5, 6.0, 14.0, 20.0}) {
        for (const double height : {0.3, 0.4, 1.0}) {
            auto flown = columns_of(sortie(100));
            flown.ground_speed_m_per_s.assign(flown.time_s.size(), 0.0);
            for (std::size_t i = 0; i < flown.time_s.size(); ++i) {
                flown.altitude_m[i] *= height;
                if (flown.time_s[i] > 99 && flown.time_s[i] < 470) flown.ground_speed_m_per_s[i] = speed_m_per_s;
            }
            EXPECT_EQ(why_none(test::series_of(flown)), "1 sorties") << speed_m_per_s << " " << height;
        }
    }
}

TEST(FlightRejection, IsNoRealFlightOfWhichNothingTellsOfTheMotor) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* log : {"flights/20_07_03__12_17_45", "flights/20_07_05__10_26_44", "flights/20_07_10__06_53_03",
                            "archives/no-power/12_05_16__07_20_45", "archives/no-power/12_05_17__07_18_57",
                            "archives/no-power/12_05_21__07_04_51"}) {
        SCOPED_TRACE(log);
        auto series =
            read_candidates(FlightFile(test::shared_dir() / (std::string(log) + ".data")), std::nullopt).at(0);
        const auto expected = segment(select_tracks(series));
        std::erase_if(series.tracks, [](const Track& track) {
            return track.name == "throttle_percent" || track.name == "power_w" || track.name == "current_a";
        });
        const auto phases = segment(select_tracks(series));
        EXPECT_EQ(phases.motor_source, "nothing");
        ASSERT_EQ(phases.sorties.size(), expected.sorties.size());
        for (std::size_t i = 0; i < phases.sorties.size(); ++i) {
            EXPECT_NEAR(phases.sorties[i].start_s(), expected.sorties[i].start_s(), 3.0);
            EXPECT_NEAR(phases.sorties[i].end_s(), expected.sorties[i].end_s(), 3.0);
        }
    }
}

TEST(FlightRejection, OfNoRealRover) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& entry : std::filesystem::directory_iterator(test::shared_dir() / "archives" / "rovers")) {
        if (entry.path().extension() != ".data") continue;
        SCOPED_TRACE(entry.path().filename());
        for (auto& series : read_candidates(FlightFile(entry.path()), std::nullopt)) {
            EXPECT_THAT(why_none(series), HasSubstr("a ground vehicle")) << series.aircraft_id;
            // Nor where nothing states what it is: by physics.
            std::erase_if(series.tracks, [](const Track& track) { return track.name == "rover_mode"; });
            series.firmware.clear();
            EXPECT_TRUE(segment(select_tracks(series)).sorties.empty()) << series.aircraft_id;
        }
    }
}

TEST(FlightRejection, SaysOfSeveralVehiclesWhatEachDid) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto log = test::shared_dir() / "archives" / "rovers" / "23_06_28__10_14_13.data";
    EXPECT_THAT(test::rejected([&] { load_flight(log); }),
                HasSubstr("none of its aircraft flew: 2 (a ground vehicle: it sends ROVER_STATUS), 1 ("));
}

/// A log of an altitude that rises and falls with a throttle, while GPS moves as given; of a fixed wing.
struct Stand {
    double speed_m_per_s = 0.5;
    double extent_m = 20.0;
    bool has_position = true;
    double airspeed_m_per_s = 0.0;
    const char* firmware = "fixedwing";
};

FlightSeries standing_series(const Stand& stand) {
    auto columns = columns_of(sortie(100));
    auto series = test::series_of(columns);
    series.firmware = stand.firmware;
    for (auto& track : series.tracks)
        if (track.name == "altitude_m") track.source = "ESTIMATOR.z";
    const auto add = [&](const char* name, const auto& value_at_s) {
        Track track{.name = name, .source = "GPS", .time_s = columns.time_s};
        for (const double t : columns.time_s) track.value.push_back(value_at_s(t));
        series.tracks.push_back(std::move(track));
    };
    add("ground_speed_m_per_s", [&](double t) { return stand.speed_m_per_s + 0.01 * std::sin(7.0 * t); });
    if (stand.has_position) {
        const double turn_per_s = 2.0 * stand.speed_m_per_s / stand.extent_m;
        add("east_m", [&](double t) { return 0.5 * stand.extent_m * std::cos(turn_per_s * t); });
        add("north_m", [&](double t) { return 0.5 * stand.extent_m * std::sin(turn_per_s * t); });
    }
    if (stand.airspeed_m_per_s > 0.0)
        add("airspeed_m_per_s", [&](double t) { return stand.airspeed_m_per_s + 0.1 * std::sin(t); });
    return series;
}

TEST(FlightRejection, OfWhatStandsByGroundSpeedAndPosition) {
    const auto stood = HasSubstr("not moved or carried");
    EXPECT_THAT(why_none(standing_series({})), stood);
    EXPECT_THAT(why_none(standing_series({.speed_m_per_s = 4.9, .extent_m = 80.0})), stood);
    EXPECT_EQ(why_none(standing_series({.speed_m_per_s = 5.1, .extent_m = 80.0})), "1 sorties");
    EXPECT_EQ(why_none(standing_series({.has_position = false})), "1 sorties") << "absent data prove nothing";
    EXPECT_EQ(why_none(standing_series({.firmware = "rotorcraft"})), "1 sorties") << "it hovers";
    // A receiver without a fix repeats its values.
    auto frozen = standing_series({});
    for (auto& track : frozen.tracks)
        if (track.name == "ground_speed_m_per_s") track.value.assign(track.value.size(), 0.0);
    EXPECT_EQ(why_none(frozen), "1 sorties");
    // Against the wind a wing may barely move, but not within the width of a field.
    EXPECT_EQ(why_none(standing_series({.extent_m = 60.0, .airspeed_m_per_s = 9.0})), "1 sorties");
    EXPECT_THAT(why_none(standing_series({.extent_m = 20.0, .airspeed_m_per_s = 9.0})), stood);
}

TEST(FlightRejection, IsWhatClimbsAtFlyingSpeedWhateverTheThrottleSays) {
    const auto phases_at = [](double airspeed_m_per_s) {
        auto series = standing_series({.speed_m_per_s = 12.0, .extent_m = 200.0, .airspeed_m_per_s = airspeed_m_per_s});
        std::erase_if(series.tracks, [](const Track& track) { return track.name == "power_w"; });
        for (auto& track : series.tracks) {
            if (track.name != "throttle_percent") continue;
            for (auto& percent : track.value) percent = percent > 50.0 ? 4.0 : 0.0;
        }
        return segment(select_tracks(series));
    };
    const auto flown = phases_at(9.0);
    EXPECT_EQ(flown.sorties.size(), 1U);
    EXPECT_THAT(flown.warnings, testing::Contains(HasSubstr("the motor is off by ")));
    EXPECT_TRUE(phases_at(6.0).sorties.empty()) << "less than any wing flies at";
}

}  // namespace
}  // namespace flightwatt::flight
