#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::exchange {

/// A position of a flown track with its measurements.
struct TrackPoint {
    double time_s = 0.0;  ///< the log's own seconds
    double longitude_deg = 0.0;
    double latitude_deg = 0.0;
    std::optional<double> altitude_m = {};  ///< see AltitudeLevel
    std::optional<double> power_w = {};
    std::optional<flight::Phase> phase = {};  ///< none on the ground
};

/// Source of a track's date and time of day.
enum class TrackClock {
    log,   ///< Unix time in the .log
    name,  ///< the log's name: local time of a ground station in an unknown time zone, used as UTC
    none
};

/// The level from which the altitudes of a track are counted.
enum class AltitudeLevel {
    sea,
    takeoff  ///< the ground of the first sortie, or the first altitude: the log has none above the sea
};

/// The positions of a flight, for maps.
struct FlownTrack {
    std::string flight;
    std::string aircraft;  ///< "20 Twinstar"
    std::vector<TrackPoint> points;
    TrackClock clock = TrackClock::none;
    double start_clock_s = 0.0;  ///< Unix time at the log's time 0, if there is a clock
    AltitudeLevel level = AltitudeLevel::sea;
};

/// Returns the track of a flight: a point for each position in degrees, with altitude and power at its time. An altitude
/// that is not above the sea is moved by its median difference in flight from one that is, if the log has one. Throws
/// InputError for fewer than two positions.
FlownTrack flown_track(const flight::FlightData& data, const flight::FlightPhases& phases);

/// Returns a time of a track that has a clock as UTC: "2020-07-03T10:17:45.170Z".
std::string utc_text(const FlownTrack& track, double time_s);

/// A segment of one phase: two or more points from `first` to `last`. The next segment begins with point `last`,
/// except at the meridian of 180 degrees, which no segment crosses (RFC 7946, 3.1.9).
struct TrackSegment {
    std::string name;    ///< "cruise", "ground"
    std::string colour;  ///< "#0072b2"
    std::size_t first = 0;
    std::size_t last = 0;
    std::optional<double> mean_power_w = {};  ///< over time, linear between the points
};

/// Divides a track into segments of one phase, in order.
std::vector<TrackSegment> phase_segments(const FlownTrack& track);

// Tracks for maps, with a line for each segment. Times are UTC, and absent without a clock.

/// Returns a track as GeoJSON (RFC 7946): a FeatureCollection of LineStrings of [longitude, latitude, altitude].
/// Properties: docs/exports.md.
std::string to_geojson(const FlownTrack& track);

/// Returns a track as KML 2.2 with Google's extension gx:Track; without a clock, a LineString.
std::string to_kml(const FlownTrack& track);

/// Returns a track as GPX 1.1: a <trk> for each segment, coloured by the extension gpx_style.
std::string to_gpx(const FlownTrack& track);

}  // namespace flightwatt::exchange
