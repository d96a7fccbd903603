#include "base/number.h"
#include "exchange/track_files.h"
#include "exchange/tracks/xml_text.h"

#include <nlohmann/json.hpp>

namespace flightwatt::exchange {
namespace {

using Json = nlohmann::ordered_json;

/// The number that the text spells: as few digits as the precision of a position is worth.
double spelt(const std::string& text) { return number_or_nan(text); }

Json coordinates(const TrackPoint& point) {
    Json place{spelt(degrees_text(point.longitude_deg)), spelt(degrees_text(point.latitude_deg))};
    if (point.altitude_m) place.push_back(spelt(metres_text(*point.altitude_m)));
    return place;
}

Json feature(const FlownTrack& track, const TrackSegment& part, TrackColour colour) {
    auto line = Json::array();
    auto times_s = Json::array();
    auto times = Json::array();
    auto powers_w = Json::array();
    for (std::size_t i = part.first; i <= part.last; ++i) {
        const auto& point = track.points[i];
        line.push_back(coordinates(point));
        times_s.push_back(point.time_s);
        if (track.clock != TrackClock::none) times.push_back(utc_text(track, point.time_s));
        if (point.power_w) powers_w.push_back(spelt(metres_text(*point.power_w)));
    }
    Json properties{{"flight", track.flight},
                    {"aircraft", track.aircraft},
                    {colour == TrackColour::phase ? "phase" : "power_class", part.name},
                    {"stroke", part.colour},
                    {"mean_power_w", part.mean_power_w ? Json(*part.mean_power_w) : Json()},
                    {"times_s", times_s},
                    {"powers_w", powers_w}};
    if (track.clock != TrackClock::none) properties["coordTimes"] = times;
    return {
        {"type", "Feature"}, {"geometry", {{"type", "LineString"}, {"coordinates", line}}}, {"properties", properties}};
}

}  // namespace

std::string to_geojson(const FlownTrack& track, TrackColour colour) {
    auto features = Json::array();
    for (const auto& part : coloured_segments(track, colour)) features.push_back(feature(track, part, colour));
    const Json collection{{"type", "FeatureCollection"}, {"features", features}};
    return collection.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace flightwatt::exchange
