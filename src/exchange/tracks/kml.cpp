#include "exchange/track_files.h"
#include "exchange/tracks/xml_text.h"

#include <set>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

constexpr auto line_width = "3";

/// KML's aabbggrr of "#rrggbb".
std::string kml_colour(const std::string& colour) {
    return "ff" + colour.substr(5, 2) + colour.substr(3, 2) + colour.substr(1, 2);
}

void add_styles(pugi::xml_node& document, const std::vector<TrackSegment>& parts) {
    std::set<std::string> colours;
    for (const auto& part : parts) colours.insert(part.colour);
    for (const auto& colour : colours) {
        auto style = document.append_child("Style");
        style.append_attribute("id") = ("c" + colour.substr(1)).c_str();
        auto line = style.append_child("LineStyle");
        add_text(line, "color", kml_colour(colour));
        add_text(line, "width", line_width);
    }
}

const char* altitude_mode(const FlownTrack& track) {
    return track.points.front().altitude_m ? "absolute" : "clampToGround";
}

void add_track(pugi::xml_node& placemark, const FlownTrack& track, const TrackSegment& part) {
    auto line = placemark.append_child("gx:Track");
    add_text(line, "altitudeMode", altitude_mode(track));
    for (std::size_t i = part.first; i <= part.last; ++i)
        add_text(line, "when", utc_text(track, track.points[i].time_s));
    for (std::size_t i = part.first; i <= part.last; ++i) {
        const auto& point = track.points[i];
        add_text(line, "gx:coord",
                 fmt::format("{} {} {}", degrees_text(point.longitude_deg), degrees_text(point.latitude_deg),
                             metres_text(point.altitude_m.value_or(0.0))));
    }
}

void add_line(pugi::xml_node& placemark, const FlownTrack& track, const TrackSegment& part) {
    auto line = placemark.append_child("LineString");
    add_text(line, "altitudeMode", altitude_mode(track));
    std::string places;
    for (std::size_t i = part.first; i <= part.last; ++i) {
        const auto& point = track.points[i];
        places += fmt::format("{}{},{}", places.empty() ? "" : " ", degrees_text(point.longitude_deg),
                              degrees_text(point.latitude_deg));
        if (point.altitude_m) places += "," + metres_text(*point.altitude_m);
    }
    add_text(line, "coordinates", places);
}

std::string description(const FlownTrack& track, const TrackSegment& part) {
    auto text =
        fmt::format("{:.1f} to {:.1f} s of the log", track.points[part.first].time_s, track.points[part.last].time_s);
    if (part.mean_power_w) text += fmt::format(", {:.1f} W on average", *part.mean_power_w);
    return text;
}

}  // namespace

std::string to_kml(const FlownTrack& track, TrackColour colour) {
    const auto parts = coloured_segments(track, colour);
    pugi::xml_document file;
    auto kml = file.append_child("kml");
    kml.append_attribute("xmlns") = "http://www.opengis.net/kml/2.2";
    kml.append_attribute("xmlns:gx") = "http://www.google.com/kml/ext/2.2";
    auto document = kml.append_child("Document");
    add_text(document, "name", track.flight);
    add_text(document, "description", track.aircraft);
    add_styles(document, parts);
    for (const auto& part : parts) {
        auto placemark = document.append_child("Placemark");
        add_text(placemark, "name", part.name);
        add_text(placemark, "description", description(track, part));
        add_text(placemark, "styleUrl", "#c" + part.colour.substr(1));
        if (track.clock == TrackClock::none)
            add_line(placemark, track, part);
        else
            add_track(placemark, track, part);
    }
    return xml_text(file);
}

}  // namespace flightwatt::exchange
