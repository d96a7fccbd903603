#include "exchange/track_files.h"
#include "exchange/tracks/xml_text.h"

#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

void add_style(pugi::xml_node& track, const std::string& colour) {
    auto extensions = track.append_child("extensions");
    auto line = extensions.append_child("line");
    line.append_attribute("xmlns") = "http://www.topografix.com/GPX/gpx_style/0/2";
    add_text(line, "color", colour.substr(1));
}

void add_point(pugi::xml_node& segment, const FlownTrack& track, const TrackPoint& point) {
    auto node = segment.append_child("trkpt");
    node.append_attribute("lat") = degrees_text(point.latitude_deg).c_str();
    node.append_attribute("lon") = degrees_text(point.longitude_deg).c_str();
    if (point.altitude_m) add_text(node, "ele", metres_text(*point.altitude_m));
    if (track.clock != TrackClock::none) add_text(node, "time", utc_text(track, point.time_s));
}

}  // namespace

std::string to_gpx(const FlownTrack& track, TrackColour colour) {
    pugi::xml_document file;
    auto gpx = file.append_child("gpx");
    gpx.append_attribute("version") = "1.1";
    gpx.append_attribute("creator") = "flightwatt " FLIGHTWATT_VERSION;
    gpx.append_attribute("xmlns") = "http://www.topografix.com/GPX/1/1";
    auto metadata = gpx.append_child("metadata");
    add_text(metadata, "name", track.flight);
    add_text(metadata, "desc", track.aircraft);
    if (track.clock != TrackClock::none) add_text(metadata, "time", utc_text(track, track.points.front().time_s));
    for (const auto& part : coloured_segments(track, colour)) {
        auto line = gpx.append_child("trk");
        add_text(line, "name", part.name);
        add_style(line, part.colour);
        auto segment = line.append_child("trkseg");
        for (std::size_t i = part.first; i <= part.last; ++i) add_point(segment, track, track.points[i]);
    }
    return xml_text(file);
}

}  // namespace flightwatt::exchange
