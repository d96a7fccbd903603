#include "exchange/flown_track.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/text.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

/// As in the report.
constexpr flight::PerPhase<const char*> phase_colours{{"#d98200", "#0072b2", "#009e73"}};
constexpr auto ground_colour = "#888888";
constexpr double half_turn_deg = 180.0;

std::optional<flight::Phase> phase_at(const flight::FlightPhases& phases, double time_s) {
    for (const auto& sortie : phases.sorties)
        for (const auto& span : sortie.phases)
            if (time_s >= span.start.time_s && time_s < span.end.time_s) return span.phase;
    return std::nullopt;
}

void set_clock(FlownTrack& track, const flight::FlightData& data) {
    if (data.start_clock_s && *data.start_clock_s > 0.0) {
        track.clock = TrackClock::log;
        track.start_clock_s = *data.start_clock_s;
    } else if (const auto start = flight::start_in_name(data.flight)) {
        track.clock = TrackClock::name;
        track.start_clock_s = static_cast<double>(start->time_since_epoch().count());
    }
}

/// The median difference of an altitude above the sea from the one that is used, in flight; std::nullopt if the log has
/// none, or one that does not change, as without a receiver.
std::optional<double> difference_from_sea_m(const flight::FlightData& data, const flight::FlightPhases& phases) {
    for (const auto& other : data.other_altitudes) {
        if (!is_above_sea(other) || is_constant(other)) continue;
        const auto used_m = resample(data.altitude_m, other.time_s);
        std::vector<double> differences_m;
        for (std::size_t i = 0; i < used_m.size(); ++i)
            if (phases.sorties.empty() || phase_at(phases, other.time_s[i]))
                differences_m.push_back(other.value[i] - used_m[i]);
        if (!differences_m.empty()) return median(std::move(differences_m));
    }
    return std::nullopt;
}

/// Sets the altitudes of a track that has points.
void set_altitudes(FlownTrack& track, const flight::FlightData& data, const flight::FlightPhases& phases) {
    if (data.altitude_m.empty()) return;
    double offset_m = 0.0;
    if (!is_above_sea(data.altitude_m)) {
        const auto difference_m = difference_from_sea_m(data, phases);
        if (!difference_m) track.level = AltitudeLevel::takeoff;
        offset_m = difference_m             ? *difference_m
                   : phases.sorties.empty() ? -value_at(data.altitude_m, track.points.front().time_s)
                                            : -phases.sorties.front().ground_altitude_m;
    }
    for (auto& point : track.points) point.altitude_m = value_at(data.altitude_m, point.time_s) + offset_m;
}

std::optional<double> mean_power_w(const FlownTrack& track, const TrackSegment& segment) {
    std::vector<double> time_s;
    std::vector<double> power_w;
    for (std::size_t i = segment.first; i <= segment.last; ++i) {
        if (!track.points[i].power_w) continue;
        time_s.push_back(track.points[i].time_s);
        power_w.push_back(*track.points[i].power_w);
    }
    if (time_s.empty()) return std::nullopt;
    const double duration_s = time_s.back() - time_s.front();
    if (!(duration_s > 0.0)) return power_w.front();
    return flight::integrated(time_s, power_w, time_s.front(), time_s.back()) / duration_s;
}

/// Adds a child element; '?' replaces bytes that are not valid in XML 1.0 in UTF-8, as in names of files.
void add_text(pugi::xml_node& parent, const char* name, std::string_view text) {
    auto clean = valid_utf8(text);
    std::ranges::replace_if(
        clean, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
    parent.append_child(name).text().set(clean.c_str());
}

std::string xml_text(pugi::xml_document& document) {
    auto declaration = document.prepend_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    std::ostringstream stream;
    document.save(stream, "  ", pugi::format_default, pugi::encoding_utf8);
    return stream.str();
}

std::string degrees_text(double degrees) { return fmt::format("{:.7f}", degrees); }

std::string metres_text(double metres) { return fmt::format("{:.2f}", metres); }

using Json = nlohmann::ordered_json;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

Json coordinates(const TrackPoint& point) {
    constexpr double per_degree = 1e7;  // about a centimetre
    Json place{rounded(point.longitude_deg, per_degree), rounded(point.latitude_deg, per_degree)};
    if (point.altitude_m) place.push_back(rounded(*point.altitude_m, 100.0));
    return place;
}

Json feature(const FlownTrack& track, const TrackSegment& segment) {
    auto line = Json::array();
    auto times_s = Json::array();
    auto times = Json::array();
    auto powers_w = Json::array();
    for (std::size_t i = segment.first; i <= segment.last; ++i) {
        const auto& point = track.points[i];
        line.push_back(coordinates(point));
        times_s.push_back(point.time_s);
        if (track.clock != TrackClock::none) times.push_back(utc_text(track, point.time_s));
        if (point.power_w) powers_w.push_back(rounded(*point.power_w, 100.0));
    }
    Json properties{{"flight", track.flight},
                    {"aircraft", track.aircraft},
                    {"phase", segment.name},
                    {"stroke", segment.colour},
                    {"mean_power_w", segment.mean_power_w ? Json(*segment.mean_power_w) : Json()},
                    {"times_s", times_s},
                    {"powers_w", powers_w}};
    if (track.level == AltitudeLevel::takeoff) properties["altitudeMode"] = "relativeToGround";
    if (track.clock != TrackClock::none) properties["coordTimes"] = times;
    return {
        {"type", "Feature"}, {"geometry", {{"type", "LineString"}, {"coordinates", line}}}, {"properties", properties}};
}

void add_style(pugi::xml_node& track, const std::string& colour) {
    auto extensions = track.append_child("extensions");
    auto line = extensions.append_child("line");
    line.append_attribute("xmlns") = "http://www.topografix.com/GPX/gpx_style/0/2";
    add_text(line, "color", colour.substr(1));
}

void add_point(pugi::xml_node& points, const FlownTrack& track, const TrackPoint& point) {
    auto node = points.append_child("trkpt");
    node.append_attribute("lat") = degrees_text(point.latitude_deg).c_str();
    node.append_attribute("lon") = degrees_text(point.longitude_deg).c_str();
    if (point.altitude_m) add_text(node, "ele", metres_text(*point.altitude_m));
    if (track.clock != TrackClock::none) add_text(node, "time", utc_text(track, point.time_s));
}

void add_line_style(pugi::xml_node& placemark, const std::string& rgb) {
    auto style = placemark.append_child("Style").append_child("LineStyle");
    add_text(style, "color", "ff" + rgb.substr(5, 2) + rgb.substr(3, 2) + rgb.substr(1, 2));  // aabbggrr
    add_text(style, "width", "3");
}

const char* altitude_mode(const FlownTrack& track) {
    if (!track.points.front().altitude_m) return "clampToGround";
    return track.level == AltitudeLevel::sea ? "absolute" : "relativeToGround";
}

void add_track(pugi::xml_node& placemark, const FlownTrack& track, const TrackSegment& segment) {
    auto line = placemark.append_child("gx:Track");
    add_text(line, "altitudeMode", altitude_mode(track));
    for (std::size_t i = segment.first; i <= segment.last; ++i)
        add_text(line, "when", utc_text(track, track.points[i].time_s));
    for (std::size_t i = segment.first; i <= segment.last; ++i) {
        const auto& point = track.points[i];
        add_text(line, "gx:coord",
                 fmt::format("{} {} {}", degrees_text(point.longitude_deg), degrees_text(point.latitude_deg),
                             metres_text(point.altitude_m.value_or(0.0))));
    }
}

void add_line(pugi::xml_node& placemark, const FlownTrack& track, const TrackSegment& segment) {
    auto line = placemark.append_child("LineString");
    add_text(line, "altitudeMode", altitude_mode(track));
    std::string places;
    for (std::size_t i = segment.first; i <= segment.last; ++i) {
        const auto& point = track.points[i];
        places += fmt::format("{}{},{}", places.empty() ? "" : " ", degrees_text(point.longitude_deg),
                              degrees_text(point.latitude_deg));
        if (point.altitude_m) places += "," + metres_text(*point.altitude_m);
    }
    add_text(line, "coordinates", places);
}

std::string description(const FlownTrack& track, const TrackSegment& segment) {
    auto text = fmt::format("{:.1f} to {:.1f} s of the log", track.points[segment.first].time_s,
                            track.points[segment.last].time_s);
    if (segment.mean_power_w) text += fmt::format(", {:.1f} W on average", *segment.mean_power_w);
    return text;
}

}  // namespace

FlownTrack flown_track(const flight::FlightData& data, const flight::FlightPhases& phases) {
    const auto& latitude = data.latitude_deg;
    const auto longitude = resample(data.longitude_deg, latitude.time_s);
    if (latitude.time_s.size() < 2 || longitude.empty()) {
        const bool in_metres = !data.east_m.empty();
        throw InputError({data.file},
                         in_metres ? "has positions only in metres, from an unknown origin" : "has no positions",
                         "expected GPS, GPS_INT or GPS_LLA messages, or latitude_deg and longitude_deg in a series");
    }
    FlownTrack track{data.flight, flight::describe_aircraft(data.aircraft_id, data.aircraft_name), {}};
    set_clock(track, data);
    const auto power = resample(data.power_w, latitude.time_s);
    for (std::size_t i = 0; i < latitude.time_s.size(); ++i) {
        TrackPoint point{latitude.time_s[i], longitude[i], latitude.value[i]};
        if (point.time_s < phases.part.start_s || point.time_s > phases.part.end_s) continue;
        if (!power.empty()) point.power_w = power[i];
        point.phase = phase_at(phases, point.time_s);
        track.points.push_back(point);
    }
    if (track.points.size() < 2) throw InputError({data.file}, "has no positions in that sortie");
    set_altitudes(track, data, phases);
    return track;
}

std::string utc_text(const FlownTrack& track, double time_s) {
    constexpr long long ms_per_s = 1000;
    const auto clock_ms = std::llround((track.start_clock_s + time_s) * static_cast<double>(ms_per_s));
    const auto ms = ((clock_ms % ms_per_s) + ms_per_s) % ms_per_s;
    const auto seconds = static_cast<std::time_t>((clock_ms - ms) / ms_per_s);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(seconds), ms);
}

std::vector<TrackSegment> phase_segments(const FlownTrack& track) {
    std::vector<TrackSegment> segments;
    bool is_open = false;
    for (std::size_t i = 0; i + 1 < track.points.size(); ++i) {
        const auto& point = track.points[i];
        if (std::abs(point.longitude_deg - track.points[i + 1].longitude_deg) > half_turn_deg) {
            is_open = false;
            continue;
        }
        const auto name = point.phase ? to_string(*point.phase) : "ground";
        if (!is_open || segments.back().name != name)
            segments.push_back(
                {std::string(name), point.phase ? phase_colours[*point.phase] : ground_colour, i, i + 1});
        segments.back().last = i + 1;
        is_open = true;
    }
    for (auto& segment : segments) segment.mean_power_w = mean_power_w(track, segment);
    return segments;
}

std::string to_geojson(const FlownTrack& track) {
    auto features = Json::array();
    for (const auto& segment : phase_segments(track)) features.push_back(feature(track, segment));
    const Json collection{{"type", "FeatureCollection"}, {"features", features}};
    return collection.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_gpx(const FlownTrack& track) {
    pugi::xml_document file;
    auto gpx = file.append_child("gpx");
    gpx.append_attribute("version") = "1.1";
    gpx.append_attribute("creator") = "flightwatt " FLIGHTWATT_VERSION;
    gpx.append_attribute("xmlns") = "http://www.topografix.com/GPX/1/1";
    auto metadata = gpx.append_child("metadata");
    add_text(metadata, "name", track.flight);
    add_text(metadata, "desc", track.aircraft);
    if (track.clock != TrackClock::none) add_text(metadata, "time", utc_text(track, track.points.front().time_s));
    for (const auto& segment : phase_segments(track)) {
        auto line = gpx.append_child("trk");
        add_text(line, "name", segment.name);
        add_style(line, segment.colour);
        auto points = line.append_child("trkseg");
        for (std::size_t i = segment.first; i <= segment.last; ++i) add_point(points, track, track.points[i]);
    }
    return xml_text(file);
}

std::string to_kml(const FlownTrack& track) {
    pugi::xml_document file;
    auto kml = file.append_child("kml");
    kml.append_attribute("xmlns") = "http://www.opengis.net/kml/2.2";
    kml.append_attribute("xmlns:gx") = "http://www.google.com/kml/ext/2.2";
    auto document = kml.append_child("Document");
    add_text(document, "name", track.flight);
    add_text(document, "description", track.aircraft);
    for (const auto& segment : phase_segments(track)) {
        auto placemark = document.append_child("Placemark");
        add_text(placemark, "name", segment.name);
        add_text(placemark, "description", description(track, segment));
        add_line_style(placemark, segment.colour);
        if (track.clock == TrackClock::none)
            add_line(placemark, track, segment);
        else
            add_track(placemark, track, segment);
    }
    return xml_text(file);
}

}  // namespace flightwatt::exchange
