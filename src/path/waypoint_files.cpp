#include "path/waypoint_files.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/input_file.h"
#include "base/toml_reader.h"
#include "path/plan_blocks.h"
#include "path/plans/json_text.h"
#include "path/plans/kml.h"
#include "path/plans/mission_files.h"
#include "path/plans/terrain.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::path {
namespace {

constexpr auto no_terrain = "has no altitudes above the terrain";
constexpr auto leave_terrain_out = "leave terrain (--terrain) out";

/// Checks and sets a value of a waypoint.
void set_value(PathEntry& entry, const EntryValue& of, double value, const Location& where) {
    require_in(of.range, value, of.name, where);
    entry.*of.value = value;
}

GeodeticPosition geographic_place(double latitude_deg, double longitude_deg, const Location& where) {
    require_in(between(-90.0, 90.0), latitude_deg, "latitude_deg", where);
    require_in(between(-180.0, 180.0), longitude_deg, "longitude_deg", where);
    return {latitude_deg, longitude_deg};
}

/// Which columns hold the place.
struct PlaceColumns {
    bool is_geographic = false;
    std::size_t first = 0;   ///< east or latitude
    std::size_t second = 0;  ///< north or longitude
};

PlaceColumns place_columns(const CsvTable& table) {
    const auto has = [&](std::string_view name) {
        return std::ranges::find(table.columns, name) != table.columns.end();
    };
    const bool is_local = has("east_m") || has("north_m");
    const bool is_geographic = has("latitude_deg") || has("longitude_deg");
    if (is_local == is_geographic) {
        throw InputError({table.file, 1}, is_local ? "has places in metres and in degrees" : "has no places",
                         "expected the columns east_m and north_m, or latitude_deg and longitude_deg");
    }
    return {is_geographic, column_index(table, is_geographic ? "latitude_deg" : "east_m"),
            column_index(table, is_geographic ? "longitude_deg" : "north_m")};
}

void refuse_other_columns(const CsvTable& table) {
    std::vector<std::string_view> known{"east_m", "north_m", "latitude_deg", "longitude_deg"};
    for (const auto& value : entry_values) known.push_back(value.name);
    for (const auto& column : table.columns) {
        if (std::ranges::find(known, column) != known.end()) continue;
        if (column == "time_s")
            throw InputError({table.file, 1}, "has the times of a flight, and is no list of waypoints",
                             "`flightwatt LOG` answers for a log");
        throw InputError({table.file, 1}, fmt::format("unknown column '{}'", column),
                         fmt::format("known are {}", fmt::join(known, ", ")));
    }
}

/// Collects the points of GeoJSON objects, or the polygons of areas.
class GeoJsonReader {
  public:
    explicit GeoJsonReader(const std::string& file, bool is_area = false) : is_area_(is_area) { at_.where = {file}; }

    void read(const Json& object) {
        const auto type = type_of(object);
        if (type == "Feature") return read_feature(object);
        if (type != "FeatureCollection") return read_geometry(object);
        const auto reference = object.contains("crs") ? object["crs"].dump() : "CRS84";
        if (reference.find("CRS84") == std::string::npos && reference.find("4326") == std::string::npos)
            refuse("has coordinates of another reference than WGS84");
        std::size_t number = 0;
        for (const auto& feature : member(object, "features", "an array", &Json::is_array)) {
            at_.name = fmt::format("feature {}", ++number);
            if (type_of(feature) != "Feature") refuse("is no Feature");
            read_feature(feature);
        }
    }

    std::vector<PathEntry> entries;
    AreaOutlines outlines;

  private:
    [[noreturn]] void refuse(const std::string& message) const {
        throw InputError(at_.where, at_.name.empty() ? message : at_.name + " " + message,
                         is_area_ ? "expected GeoJSON: Polygons, alone, as features or in a FeatureCollection"
                                  : "expected GeoJSON: Points and LineStrings, alone, as features or in a "
                                    "FeatureCollection; a Polygon is an area of [path]");
    }

    std::string type_of(const Json& object) const {
        if (!object.is_object()) refuse("is no object");
        return member(object, "type", "a text", &Json::is_string).get<std::string>();
    }

    const Json& member(const Json& object, const char* name, const char* kind,
                       bool (Json::*is)() const noexcept) const {
        const auto found = object.find(name);
        if (found == object.end() || !((*found).*is)()) refuse(fmt::format("has no '{}' that is {}", name, kind));
        return *found;
    }

    void read_feature(const Json& feature) {
        const auto first = entries.size();
        const auto properties = feature.find("properties");
        const bool has_properties = properties != feature.end() && properties->is_object();
        is_closed_ = is_area_ && has_properties && is_no_fly(*properties);
        outlines.has_altitudes |=
            is_area_ && has_properties && !is_closed_ && properties->value("altitude_m", Json()).is_number();
        read_geometry(member(feature, "geometry", "a geometry", &Json::is_object));
        if (is_area_ || !has_properties) return;
        for (const auto& of : entry_values) {
            const auto value = properties->find(of.name);
            if (value == properties->end() || value->is_null()) continue;
            if (!value->is_number()) refuse(fmt::format("has a '{}' that is no number", of.name));
            for (std::size_t i = first; i < entries.size(); ++i)
                set_value(entries[i], of, value->get<double>(), at_.where);
        }
    }

    void read_geometry(const Json& geometry) {
        const auto type = type_of(geometry);
        if (is_area_) return read_area(geometry, type);
        if (type != "Point" && type != "LineString" && type != "MultiPoint")
            refuse(fmt::format("is a {}, which is no path", type));
        const auto& coordinates = member(geometry, "coordinates", "an array", &Json::is_array);
        if (type == "Point") return read_position(coordinates);
        for (const auto& position : coordinates) read_position(position);
    }

    bool is_no_fly(const Json& properties) const {
        const auto value = properties.value("no_fly", Json(false));
        if (!value.is_boolean()) refuse("has a 'no_fly' that is not true or false");
        return value.get<bool>();
    }

    void read_area(const Json& geometry, const std::string& type) {
        const auto& coordinates = member(geometry, "coordinates", "an array", &Json::is_array);
        if (type == "Polygon") return read_polygon(coordinates);
        if (type != "MultiPolygon") refuse(fmt::format("is a {}, which is no area", type));
        for (const auto& polygon : coordinates) read_polygon(polygon);
    }

    /// Rings after the first are holes.
    void read_polygon(const Json& rings) {
        if (!rings.is_array() || rings.empty() || !rings.front().is_array()) refuse("has no outer ring");
        bool is_hole = false;
        for (const auto& ring : rings) {
            entries.clear();
            for (const auto& position : ring) read_position(position);
            auto& outline = (is_closed_ || is_hole ? outlines.closed : outlines.areas).emplace_back();
            for (const auto& corner : entries) {
                outline.push_back(*corner.geographic);
                outlines.has_altitudes |= !is_closed_ && corner.altitude_m.value_or(0.0) != 0.0;
            }
            is_hole = true;
        }
    }

    /// Longitude comes first.
    void read_position(const Json& position) {
        const bool is_position = position.is_array() && (position.size() == 2 || position.size() == 3) &&
                                 std::ranges::all_of(position, [](const Json& part) { return part.is_number(); });
        if (!is_position) refuse("has a position that is not [longitude, latitude] or [longitude, latitude, altitude]");
        PathEntry entry;
        entry.where = at_.where;
        entry.name = fmt::format("waypoint {}", entries.size() + 1);
        entry.geographic = geographic_place(position[1].get<double>(), position[0].get<double>(), at_.where);
        if (position.size() == 3) set_value(entry, entry_values.front(), position[2].get<double>(), at_.where);
        entries.push_back(std::move(entry));
    }

    PathEntry at_;  ///< where it reads: file and feature
    bool is_area_;
    bool is_closed_ = false;  ///< the feature is not flown over
};

/// Makes altitudes above the ground those above home, by the heights of the terrain.
void follow_terrain(const AutopilotSettings& settings, PlanEntries& plan) {
    Terrain terrain(settings.terrain);
    const auto home = settings.home.value_or(*plan.entries.front().geographic);
    for (auto& entry : plan.entries) {
        entry.is_above_terrain = entry.altitude_m.has_value();
        if (entry.altitude_m) *entry.altitude_m += terrain.ground_m(*entry.geographic) - terrain.ground_m(home);
    }
    auto path = along_terrain(plan.entries, terrain, home, settings.returns_to_start);
    plan.entries = std::move(path.entries);
    for (const auto& text : path.below_ground) {
        plan.not_flown.push_back(text);
        plan.missing.push_back(text);
    }
}

}  // namespace

std::vector<PathEntry> parse_waypoint_csv(std::string_view text, const std::string& file) {
    const auto table = parse_csv(text, file);
    refuse_other_columns(table);
    const auto places = place_columns(table);
    std::vector<PathEntry> entries;
    for (const auto& row : table.rows) {
        PathEntry entry;
        entry.name = fmt::format("waypoint {}", entries.size() + 1);
        entry.where = {file, row.line};
        const double first = cell_number(table, row, places.first);
        const double second = cell_number(table, row, places.second);
        if (places.is_geographic)
            entry.geographic = geographic_place(first, second, entry.where);
        else
            entry.place = LocalPosition{first, second};
        for (const auto& value : entry_values) {
            const auto column = std::ranges::find(table.columns, value.name) - table.columns.begin();
            const auto index = static_cast<std::size_t>(column);
            if (index == table.columns.size() || row.cells[index].text.empty()) continue;
            set_value(entry, value, cell_number(table, row, index), {file, row.line, row.cells[index].column});
        }
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) throw InputError({file}, "has no waypoints");
    return entries;
}

std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file) {
    GeoJsonReader reader(file);
    reader.read(parse_json(text, file, "expected GeoJSON: Points and LineStrings"));
    if (reader.entries.empty()) throw InputError({file}, "has no waypoints");
    return std::move(reader.entries);
}

AreaOutlines geojson_area(std::string_view text, const std::string& file) {
    GeoJsonReader reader(file, true);
    reader.read(parse_json(text, file, "expected GeoJSON: a Polygon"));
    return std::move(reader.outlines);
}

PlanEntries parse_kml(std::string_view text, const std::string& file, const AutopilotSettings& settings) {
    constexpr auto hint =
        "expected KML with a path (LineString) or places (Point); a flight plan of Paparazzi is the path's flight_plan "
        "with blocks, a polygon of KML its area";
    const auto document = load_kml(text, file, hint);
    auto coordinates = document.select_nodes("//LineString/coordinates");
    const auto points = document.select_nodes("//Point/coordinates");
    const bool has_tracks =
        !document.select_nodes("//*[local-name()='Track'] | //LinearRing[not(ancestor::Polygon)]").empty();
    if (coordinates.empty() && has_tracks)
        throw InputError({file}, "has tracks or rings (gx:Track, LinearRing), and no path (LineString)",
                         "save the way that is to be flown as a path");
    PlanEntries plan;
    if (coordinates.empty())
        coordinates = points;
    else if (!points.empty())
        plan.not_flown.emplace_back("its points are not flown to: it has a path");
    if (has_tracks) {
        plan.not_flown.emplace_back("its tracks and rings (gx:Track, LinearRing) are not flown: it has a path");
        plan.missing.push_back(plan.not_flown.back());
    }
    std::set<double> ignored_m;
    std::set<std::string> modes;
    for (const auto& node : coordinates) {
        const std::string mode = node.node().parent().child_value("altitudeMode");
        const bool has_altitude = mode == "absolute" || mode == "relativeToGround";
        for (const auto& [place, altitude_m] : kml_places(node.node(), file)) {
            auto& entry = plan.entries.emplace_back();
            entry.name = fmt::format("waypoint {}", plan.entries.size());
            entry.where = {file};
            entry.geographic = place;
            entry.waits_for_altitude = settings.is_rotorcraft;
            if (has_altitude && altitude_m) {
                set_value(entry, entry_values.front(), *altitude_m, entry.where);
                modes.insert(mode);
            } else {
                ignored_m.insert(altitude_m.value_or(0.0));
            }
        }
    }
    if (plan.entries.empty()) throw InputError({file}, "has no waypoints", hint);
    if (modes.size() > 1)
        throw InputError({file}, "has altitudes above the sea and above the ground", "give one altitudeMode");
    const auto report = [&](const char* remark, bool is_missing) {
        plan.not_flown.emplace_back(remark);
        if (is_missing) plan.missing.emplace_back(remark);
    };
    plan.is_above_home = modes.contains("relativeToGround");
    plan.is_above_sea = modes.contains("absolute");
    if (!settings.terrain.empty() && !plan.is_above_home) throw InputError({file}, no_terrain, leave_terrain_out);
    if (plan.is_above_home && settings.terrain.empty())
        report("altitudes above the ground are flown as above that of its start", true);
    else if (plan.is_above_home)
        follow_terrain(settings, plan);
    if (ignored_m.size() > 1 || ignored_m.count(0.0) != ignored_m.size())
        report("altitudes that its altitudeMode clamps to the ground are not flown", ignored_m.size() > 1);
    return plan;
}

namespace {

PlanEntries read_any_waypoints(const std::filesystem::path& path, const AutopilotSettings& settings) {
    auto ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto text = read_file(path);
    const auto format = plan_format(text);
    const bool is_geojson = ending == ".geojson" || ending == ".json";
    if (!settings.terrain.empty() && (is_geojson || format == PlanFormat::none))
        throw InputError({path.string()}, no_terrain, leave_terrain_out);
    if (is_geojson) return {parse_geojson(text, path.string())};
    switch (format) {
        case PlanFormat::qgroundcontrol:
            return parse_qgc_plan(text, path.string(), settings);
        case PlanFormat::ardupilot:
            return parse_wpl(text, path.string(), settings);
        case PlanFormat::flight_plan:
            return parse_kml(text, path.string(), settings);
        default:
            require_kind(text, FileKind::plan, path.string());
            return {parse_waypoint_csv(text, path.string())};
    }
}

}  // namespace

PlanEntries read_waypoints(const std::filesystem::path& path, const AutopilotSettings& settings) {
    auto plan = read_any_waypoints(path, settings);
    if (settings.one_airspeed)
        for (auto& entry : plan.entries) entry.airspeed_m_per_s.reset();
    return plan;
}

}  // namespace flightwatt::path
