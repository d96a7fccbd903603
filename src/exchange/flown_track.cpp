#include "exchange/flown_track.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <set>
#include <sstream>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

/// The report's colours of phases.
constexpr flight::PerPhase<const char*> phase_colours{{"#d98200", "#0072b2", "#009e73"}};
constexpr auto ground_colour = "#888888";
constexpr std::size_t classes_of_power = 6;
/// From dark to light (viridis of matplotlib, which is readable without colour vision too).
constexpr std::array<const char*, classes_of_power> power_colours{"#440154", "#414487", "#2a788e",
                                                                  "#22a884", "#7ad151", "#fde725"};
constexpr double half_turn_deg = 180.0;

std::optional<flight::Phase> phase_at(const flight::FlightPhases& phases, double time_s) {
    for (const auto& sortie : phases.sorties)
        for (const auto& span : sortie.phases)
            if (time_s >= span.start.time_s && time_s < span.end.time_s) return span.phase;
    return std::nullopt;
}

void set_clock(FlownTrack& track, const flight::FlightSeries& series) {
    if (series.start_clock_s && *series.start_clock_s > 0.0) {
        track.clock = TrackClock::log;
        track.start_clock_s = *series.start_clock_s;
    } else if (const auto start = flight::start_in_name(series.flight)) {
        track.clock = TrackClock::name;
        track.start_clock_s = static_cast<double>(start->time_since_epoch().count());
    }
}

/// 1, 2 or 5 times a power of ten, and no less than `step`.
double round_step(double step) {
    const double magnitude = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * magnitude >= step) return factor * magnitude;
    return 10.0 * magnitude;
}

/// The width of a class of power.
double power_step_w(const FlownTrack& track) {
    std::vector<double> powers_w;
    for (const auto& point : track.points)
        if (point.power_w) powers_w.push_back(std::max(0.0, *point.power_w));
    if (powers_w.empty()) {
        throw InputError({track.flight}, "measured no power, by which its track could be coloured",
                         "colour it by phase");
    }
    constexpr double most = 0.95;
    const auto place = static_cast<std::ptrdiff_t>(most * static_cast<double>(powers_w.size() - 1));
    std::ranges::nth_element(powers_w, powers_w.begin() + place);
    const double high_w = powers_w[static_cast<std::size_t>(place)];
    return high_w > 0.0 ? round_step(high_w / static_cast<double>(classes_of_power)) : 1.0;
}

struct Drawn {
    std::string name;
    std::string colour;
};

Drawn drawn_by_phase(const TrackPoint& point) {
    if (!point.phase) return {"ground", ground_colour};
    return {std::string(to_string(*point.phase)), phase_colours[*point.phase]};
}

Drawn drawn_by_power(const TrackPoint& point, double step_w) {
    if (!point.power_w) return {"no power measured", ground_colour};
    const double steps = std::clamp(std::floor(*point.power_w / step_w), 0.0, double{classes_of_power - 1});
    const auto number = static_cast<std::size_t>(steps);
    const double low_w = steps * step_w;
    if (number + 1 == classes_of_power) return {fmt::format("{:g} W and more", low_w), power_colours[number]};
    return {fmt::format("{:g} to {:g} W", low_w, low_w + step_w), power_colours.at(number)};
}

bool crosses_antimeridian(const TrackPoint& from, const TrackPoint& to) {
    return std::abs(from.longitude_deg - to.longitude_deg) > half_turn_deg;
}

std::optional<double> mean_power_w(const FlownTrack& track, const TrackSegment& part) {
    std::vector<double> time_s;
    std::vector<double> power_w;
    for (std::size_t i = part.first; i <= part.last; ++i) {
        if (!track.points[i].power_w) continue;
        time_s.push_back(track.points[i].time_s);
        power_w.push_back(*track.points[i].power_w);
    }
    if (time_s.empty()) return std::nullopt;
    const double duration_s = time_s.back() - time_s.front();
    if (!(duration_s > 0.0)) return power_w.front();
    return flight::integrated(time_s, power_w, time_s.front(), time_s.back()) / duration_s;
}

}  // namespace

FlownTrack flown_track(const flight::FlightSeries& series, const flight::FlightPhases& phases) {
    const auto latitude = select_track(series, "latitude_deg");
    const auto longitude = sample_selected_track(series, "longitude_deg", latitude.time_s);
    if (latitude.time_s.size() < 2 || longitude.empty()) {
        const bool in_metres = !select_track(series, "east_m").empty();
        throw InputError({series.file},
                         in_metres ? "has positions in metres alone, from an origin that it does not tell"
                                   : "has no positions, of which a track is made",
                         "expected GPS, GPS_INT or GPS_LLA messages, or latitude_deg and longitude_deg in a series");
    }
    FlownTrack track{series.flight, flight::describe_aircraft(series.aircraft_id, series.aircraft_name), {}};
    set_clock(track, series);
    const auto altitude = sample_selected_track(series, "altitude_m", latitude.time_s);
    const auto power = sample_selected_track(series, "power_w", latitude.time_s);
    for (std::size_t i = 0; i < latitude.time_s.size(); ++i) {
        TrackPoint point{latitude.time_s[i], longitude[i], latitude.value[i]};
        if (!altitude.empty()) point.altitude_m = altitude[i];
        if (!power.empty()) point.power_w = power[i];
        point.phase = phase_at(phases, point.time_s);
        track.points.push_back(point);
    }
    return track;
}

std::string utc_text(const FlownTrack& track, double time_s) {
    constexpr long long ms_per_s = 1000;
    const auto clock_ms = std::llround((track.start_clock_s + time_s) * static_cast<double>(ms_per_s));
    const auto ms = ((clock_ms % ms_per_s) + ms_per_s) % ms_per_s;
    const auto seconds = static_cast<std::time_t>((clock_ms - ms) / ms_per_s);
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(seconds), ms);
}

std::vector<TrackSegment> coloured_segments(const FlownTrack& track, TrackColour colour) {
    const double step_w = colour == TrackColour::power ? power_step_w(track) : 0.0;
    std::vector<TrackSegment> parts;
    bool is_open = false;
    for (std::size_t i = 0; i + 1 < track.points.size(); ++i) {
        const auto& point = track.points[i];
        if (crosses_antimeridian(point, track.points[i + 1])) {
            is_open = false;
            continue;
        }
        const auto drawn = colour == TrackColour::phase ? drawn_by_phase(point) : drawn_by_power(point, step_w);
        if (!is_open || parts.back().name != drawn.name) parts.push_back({drawn.name, drawn.colour, i, i + 1});
        parts.back().last = i + 1;
        is_open = true;
    }
    for (auto& part : parts) part.mean_power_w = mean_power_w(track, part);
    return parts;
}

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
