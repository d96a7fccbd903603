#pragma once

#include "exchange/flown_track.h"

#include <string>

/// Tracks for maps. A part of coloured_segments becomes a line of its own; altitudes are the log's, above sea level.
/// Times are UTC, and absent where the track has no clock. What coloured_segments throws.
namespace flightwatt::exchange {

/// GeoJSON (RFC 7946): a FeatureCollection with a LineString a part, [longitude, latitude, altitude]. Properties:
/// docs/exports.md.
std::string to_geojson(const FlownTrack& track, TrackColour colour);

/// KML 2.2 with Google's extension: a gx:Track a part, or a LineString without a clock.
std::string to_kml(const FlownTrack& track, TrackColour colour);

/// GPX 1.1: a <trk> a part, coloured by the extension gpx_style.
std::string to_gpx(const FlownTrack& track, TrackColour colour);

}  // namespace flightwatt::exchange
