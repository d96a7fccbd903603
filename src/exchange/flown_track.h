#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::exchange {

/// Where an aircraft was at one time.
struct TrackPoint {
    double time_s = 0.0;  ///< the log's own seconds
    double longitude_deg = 0.0;
    double latitude_deg = 0.0;
    std::optional<double> altitude_m = {};  ///< above sea level, as the log has it
    std::optional<double> power_w = {};
    std::optional<flight::Phase> phase = {};  ///< none on the ground
};

/// What tells the date of a track's seconds.
enum class TrackClock {
    log,   ///< the .log: Unix time
    name,  ///< the log's name, by the clock of a ground station whose time zone is not known: taken for UTC
    none
};

struct FlownTrack {
    std::string flight;
    std::string aircraft;  ///< "20 Twinstar"
    std::vector<TrackPoint> points;
    TrackClock clock = TrackClock::none;
    double start_clock_s = 0.0;  ///< Unix time of the log's second 0, where there is a clock
};

/// A point each time that the log has a position in degrees, with altitude and power of that time. Throws InputError
/// where the log has fewer than two.
FlownTrack flown_track(const flight::FlightSeries& series, const flight::FlightPhases& phases);

/// "2020-07-03T10:17:45.170Z", of a track that has a clock.
std::string utc_text(const FlownTrack& track, double time_s);

/// What colours a track.
enum class TrackColour { phase, power };

/// A part of a track that is drawn in one colour: its points from `first` to `last`, two or more. The next part begins
/// with the point that this one ends with, but for the meridian of 180 degrees, which no part crosses (RFC 7946,
/// 3.1.9).
struct TrackSegment {
    std::string name;    ///< "cruise", "ground"; "20 to 40 W"
    std::string colour;  ///< "#0072b2"
    std::size_t first = 0;
    std::size_t last = 0;
    std::optional<double> mean_power_w = {};  ///< over its time, linear between its points
};

/// The whole track in parts. Classes of power are six equal, round steps from 0 to what 95 % of the points are below.
/// Throws InputError for the colour of power where the log measured none.
std::vector<TrackSegment> coloured_segments(const FlownTrack& track, TrackColour colour);

// Tracks for maps. A part of coloured_segments becomes a line of its own; altitudes are the log's, above sea level.
// Times are UTC, and absent where the track has no clock. What coloured_segments throws.

/// GeoJSON (RFC 7946): a FeatureCollection with a LineString a part, [longitude, latitude, altitude]. Properties:
/// docs/exports.md.
std::string to_geojson(const FlownTrack& track, TrackColour colour);

/// KML 2.2 with Google's extension: a gx:Track a part, or a LineString without a clock.
std::string to_kml(const FlownTrack& track, TrackColour colour);

/// GPX 1.1: a <trk> a part, coloured by the extension gpx_style.
std::string to_gpx(const FlownTrack& track, TrackColour colour);

}  // namespace flightwatt::exchange
