#include "exchange/track_files.h"

#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

/// A child element that holds `text`, in which '?' stands for bytes that XML 1.0 in UTF-8 cannot hold.
void add_text(pugi::xml_node& parent, const char* name, std::string_view text) {
    auto clean = valid_utf8(text);  // a file's name may be any bytes
    std::ranges::replace_if(
        clean, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
    parent.append_child(name).text().set(clean.c_str());
}

/// The document, indented, after the declaration that it is given.
std::string xml_text(pugi::xml_document& document) {
    auto declaration = document.prepend_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    std::ostringstream stream;
    document.save(stream, "  ", pugi::format_default, pugi::encoding_utf8);
    return stream.str();
}

/// 7 decimals are a centimetre.
std::string degrees_text(double degrees) { return fmt::format("{:.7f}", degrees); }

std::string metres_text(double metres) { return fmt::format("{:.2f}", metres); }

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
