#include "flight/segment/flight_rejection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;
using Values = std::function<double(double time_s)>;

Values constant(double value) {
    return [=](double) { return value; };
}
/// One value before a time, another from it on.
Values changing(double before, double at_s, double after) {
    return [=](double time_s) { return time_s < at_s ? before : after; };
}
/// Two values in turn, each for so long, until a time.
Values alternating(double a, double b, double each_s, double until_s = 100.0) {
    return [=](double time_s) { return static_cast<int>(std::min(time_s, until_s) / each_s) % 2 == 0 ? a : b; };
}
/// From 50 m on, from 20 s on.
Values rising(double by_m, double for_s) {
    return [=](double time_s) { return 50.0 + by_m * std::clamp((time_s - 20.0) / for_s, 0.0, 1.0); };
}

Track track_of(const std::string& name, const std::string& source, const Values& values, double interval_s = 1.0) {
    Track track{.name = name, .source = source};
    for (int i = 0; i * interval_s <= 100.0; ++i) {
        track.time_s.push_back(i * interval_s);
        track.value.push_back(values(i * interval_s));
    }
    return track;
}

/// What there is to know of an activity of a hundred seconds.
struct Evidence {
    Values altitude_m = constant(50.0);
    double altitude_interval_s = 1.0;
    Values height_m = nullptr;  ///< the altitude, unless given
    Values motor_percent = constant(50.0);
    Values ground_speed_m_per_s = nullptr;
    bool is_from_ground = false;
    std::vector<Track> tracks = {};
};

/// Why it is no flight.
std::string why_none(const Evidence& evidence) {
    ResampledFlight grid;
    Heights heights;
    for (double time_s = 0.0; time_s <= 100.0; time_s += grid.step_s) {
        grid.altitude_m.push_back(evidence.altitude_m(time_s));
        if (evidence.motor_percent) grid.motor_percent.push_back(evidence.motor_percent(time_s));
        if (evidence.ground_speed_m_per_s) grid.ground_speed_m_per_s.push_back(evidence.ground_speed_m_per_s(time_s));
        heights.height_m.push_back((evidence.height_m ? evidence.height_m : evidence.altitude_m)(time_s));
    }
    if (evidence.motor_percent) grid.motor_indicator = MotorIndicator::throttle;
    heights.max_m = std::ranges::max(heights.height_m);
    FlightSeries series;
    series.tracks = {track_of("altitude_m", "ESTIMATOR.z", evidence.altitude_m, evidence.altitude_interval_s)};
    series.tracks.insert(series.tracks.end(), evidence.tracks.begin(), evidence.tracks.end());
    const auto tracks = select_tracks(series);
    grid.has_altitude.assign(grid.size(), true);
    Activity activity{{0, grid.size()}, {0, grid.size()}, std::nullopt, std::nullopt};
    if (evidence.is_from_ground) {
        activity.moving = {1, grid.size() - 1};
        activity.ground_before = activity.ground_after = GroundLevel{};
    }
    const SegmentationOptions options;
    return no_flight_reason({tracks, grid, activity, heights, options});
}

TEST(FlightRejectionLimits, OfClimbs) {
    const auto climbs = [](double m_per_s, double for_s) {
        return why_none({.altitude_m = rising(m_per_s * for_s, for_s)});
    };
    EXPECT_THAT(climbs(61.0, 5.5), HasSubstr("m/s for 5 s: its estimator diverged"));
    EXPECT_EQ(climbs(61.0, 4.5), "");
    EXPECT_EQ(climbs(59.0, 5.5), "");
    EXPECT_THAT(climbs(31.0, 31.0), HasSubstr("m/s for 30 s: its estimator diverged"));
    EXPECT_EQ(climbs(31.0, 29.0), "");
    EXPECT_EQ(climbs(29.0, 31.0), "");
}

TEST(FlightRejectionLimits, OfAnAirspeedThatShowsFlightWithTheMotorOff) {
    const auto flies = [](double airspeed_m_per_s, double climb_m_in_20_s) {
        const auto airspeed = alternating(airspeed_m_per_s, airspeed_m_per_s + 0.05, 1.0);
        return why_none({.altitude_m = rising(3.0 * climb_m_in_20_s, 60.0),
                         .motor_percent = constant(0.0),
                         .tracks = {track_of("airspeed_m_per_s", "AIRSPEED.airspeed", airspeed)}});
    };
    EXPECT_EQ(flies(7.1, 15.1), "");
    EXPECT_THAT(flies(6.9, 15.1), HasSubstr("its estimator has no fix"));
    EXPECT_THAT(flies(7.1, 14.9), HasSubstr("its estimator has no fix"));
}

/// An altitude that moves from sample to sample or as given, next to a GPS and a barometer.
std::string beside_gps(const Values& own_m, const Values& gps_m, double gps_interval_s = 1.0,
                       const Values& barometer_m = constant(0.0)) {
    return why_none({.altitude_m = own_m,
                     .height_m = constant(50.0),
                     .tracks = {track_of("altitude_m", "GPS.alt", gps_m, gps_interval_s),
                                track_of("altitude_m", "AIR_DATA.amsl_baro", barometer_m)}});
}

TEST(FlightRejectionLimits, OfAGpsThatStandsStill) {
    const auto ran_away = HasSubstr("its estimator diverged");
    const auto moves = [](double by_m, double each_s = 1.0, double until_s = 100.0) {
        return alternating(600.0, 600.0 + by_m, each_s, until_s);
    };
    EXPECT_THAT(beside_gps(alternating(0.0, 12.0, 1.0), moves(2.9)), ran_away) << "a quarter is 3 m";
    EXPECT_EQ(beside_gps(alternating(0.0, 12.0, 1.0), moves(3.1)), "");
    const auto own_m = alternating(0.0, 24.0, 1.0);
    EXPECT_THAT(beside_gps(own_m, moves(4.9)), ran_away) << "half of the least height of a flight";
    EXPECT_EQ(beside_gps(own_m, moves(5.1)), "");
    EXPECT_THAT(beside_gps(own_m, moves(2.0, 11.0), 11.0), ran_away) << "ten samples";
    EXPECT_EQ(beside_gps(own_m, moves(2.0, 12.0), 12.0), "");
    EXPECT_THAT(beside_gps(own_m, moves(2.0, 5.0, 55.0), 5.0), ran_away) << "11 of 21 change";
    EXPECT_EQ(beside_gps(own_m, moves(2.0, 5.0, 50.0), 5.0), "");
    EXPECT_THAT(beside_gps(own_m, moves(2.0), 1.0, alternating(0.0, 11.9, 1.0)), ran_away);
    EXPECT_EQ(beside_gps(own_m, moves(2.0), 1.0, alternating(0.0, 12.1, 1.0)), "") << "confirmed by half of it";
    // A twentieth above and below does not count: of 101 samples five.
    EXPECT_THAT(beside_gps(changing(0.0, 95.0, 20.0), moves(2.0)), ran_away);
    EXPECT_EQ(beside_gps(changing(0.0, 96.0, 20.0), moves(2.0)), "");
    EXPECT_THAT(beside_gps(changing(0.0, 6.0, 20.0), moves(2.0)), ran_away);
    EXPECT_EQ(beside_gps(changing(0.0, 5.0, 20.0), moves(2.0)), "");
}

TEST(FlightRejectionLimits, OfAnAltitudeAlone) {
    const auto with_heights = [](const Values& height_m, const Values& speed_m_per_s = nullptr) {
        return why_none({.height_m = height_m, .motor_percent = nullptr, .ground_speed_m_per_s = speed_m_per_s});
    };
    const auto settles = HasSubstr("its estimator converged");
    EXPECT_THAT(with_heights(changing(30.0, 14.5, 0.0)), settles);
    EXPECT_EQ(with_heights(changing(30.0, 15.0, 0.0)), "");
    const auto in_two_levels = [&](double low_m) {
        return with_heights([=](double time_s) { return time_s < 10.0 ? 30.0 : time_s < 20.0 ? low_m : 0.0; });
    };
    EXPECT_THAT(in_two_levels(14.7), settles) << "less than half of the height";
    EXPECT_EQ(in_two_levels(15.3), "");
    EXPECT_THAT(with_heights(constant(19.9)), settles);
    EXPECT_EQ(with_heights(constant(20.1)), "");
    EXPECT_THAT(with_heights(constant(30.0), changing(6.0, 10.0, 4.0)), settles) << "fast for 20 of 201 samples";
    EXPECT_EQ(with_heights(constant(30.0), changing(6.0, 10.5, 4.0)), "");
}

TEST(FlightRejectionLimits, OfRoads) {
    const auto drives = [](double by_m, double for_s, double interval_s = 1.0) {
        return why_none({.altitude_m = rising(by_m, for_s),
                         .altitude_interval_s = interval_s,
                         .ground_speed_m_per_s = constant(10.0),
                         .is_from_ground = true});
    };
    const auto driven = HasSubstr("from ground to ground: driven");
    EXPECT_THAT(drives(3.4, 0.5), driven) << "3 % of 50 m and 2 m";
    EXPECT_EQ(drives(3.6, 0.5), "");
    EXPECT_THAT(drives(4.9, 10.0), driven);
    EXPECT_EQ(drives(5.1, 10.0), "");
    EXPECT_THAT(drives(10.9, 30.0), driven);
    EXPECT_EQ(drives(11.1, 30.0), "");
    EXPECT_THAT(drives(0.0, 1.0, 5.0), driven);
    EXPECT_EQ(drives(0.0, 1.0, 5.3), "") << "seen too rarely";
}

TEST(FlightRejectionLimits, OfAnAircraftThatStands) {
    const auto stands = [](double extent_m, bool has_airspeed, double speed_until_s = 100.0) {
        const auto jitter = alternating(0.0, 0.1, 1.0);
        const auto east_m = [=](double time_s) { return alternating(0.0, extent_m, 10.5)(time_s) + jitter(time_s); };
        const auto speed = alternating(0.4, 0.6, 1.0, speed_until_s);
        std::vector<Track> tracks{track_of("ground_speed_m_per_s", "GPS.speed", speed),
                                  track_of("east_m", "GPS.utm_east", east_m),
                                  track_of("north_m", "GPS.utm_north", jitter)};
        if (has_airspeed) tracks.push_back(track_of("airspeed_m_per_s", "AIRSPEED.airspeed", alternating(8, 9, 1)));
        return why_none({.tracks = std::move(tracks)});
    };
    const auto stood = HasSubstr("not moved or carried");
    EXPECT_THAT(stands(49.0, false), stood) << "4.9 m/s over ten seconds";
    EXPECT_EQ(stands(51.0, false), "");
    EXPECT_THAT(stands(29.0, true), stood);
    EXPECT_EQ(stands(31.0, true), "") << "against the wind";
    EXPECT_THAT(stands(20.0, false, 10.0), stood) << "ten changes";
    EXPECT_EQ(stands(20.0, false, 9.0), "");
}

}  // namespace
}  // namespace flightwatt::flight
