#include "path/waypoint_files.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/number.h"
#include "base/toml_reader.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::path {
namespace {

/// Checks and sets a value of a waypoint.
void set_value(PathEntry& entry, std::string_view name, double value, const Location& where) {
    const auto checked = [&](NumberRange range) {
        require_in(range, value, name, where);
        return value;
    };
    if (name == "altitude_m") entry.altitude_m = checked(between(-1e5, 1e5));
    if (name == "airspeed_m_per_s") entry.airspeed_m_per_s = checked(more_than_up_to(0.0, max_m_per_s));
    if (name == "duration_s") entry.duration_s = checked(more_than_up_to(0.0, 1e7));
    if (name == "hold_s") entry.hold_s = checked(more_than_up_to(0.0, 1e7));
    if (name == "circles") entry.circles = checked(more_than_up_to(0.0, largest_circle_count));
    if (name == "radius_m") entry.radius_m = checked(between(min_radius_m, max_radius_m));
}

constexpr std::array waypoint_values{"altitude_m", "airspeed_m_per_s", "duration_s", "hold_s", "circles", "radius_m"};

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
    for (const auto& column : table.columns) {
        constexpr std::array places{"east_m", "north_m", "latitude_deg", "longitude_deg"};
        if (std::ranges::find(places, column) != places.end()) continue;
        if (std::ranges::find(waypoint_values, column) != waypoint_values.end()) continue;
        throw InputError({table.file, 1}, fmt::format("unknown column '{}'", column),
                         fmt::format("known are {} and {}", fmt::join(places, ", "), fmt::join(waypoint_values, ", ")));
    }
}

using Json = nlohmann::json;

[[noreturn]] void refuse_geojson(const PathEntry& entry, const std::string& message) {
    throw InputError(entry.where, entry.name.empty() ? message : entry.name + " " + message,
                     "expected GeoJSON: Points and LineStrings, alone, as features or in a FeatureCollection");
}

/// Collects the points of GeoJSON objects.
class GeoJsonReader {
  public:
    explicit GeoJsonReader(const std::string& file) { at_.where = {file}; }

    void read(const Json& object) {
        const auto type = type_of(object);
        if (type == "FeatureCollection") {
            refuse_other_reference(object);
            std::size_t number = 0;
            for (const auto& feature : member(object, "features", "an array", &Json::is_array)) {
                at_.name = fmt::format("feature {}", ++number);
                if (type_of(feature) != "Feature") refuse_geojson(at_, "is no Feature");
                read_feature(feature);
            }
        } else if (type == "Feature") {
            read_feature(object);
        } else {
            read_geometry(object);
        }
    }

    std::vector<PathEntry> entries;

  private:
    std::string type_of(const Json& object) const {
        if (!object.is_object()) refuse_geojson(at_, "is no object");
        return member(object, "type", "a text", &Json::is_string).get<std::string>();
    }

    const Json& member(const Json& object, const char* name, const char* kind,
                       bool (Json::*is)() const noexcept) const {
        const auto found = object.find(name);
        if (found == object.end() || !((*found).*is)())
            refuse_geojson(at_, fmt::format("has no '{}' that is {}", name, kind));
        return *found;
    }

    void refuse_other_reference(const Json& object) const {
        if (object.contains("crs") && object["crs"].dump().find("CRS84") == std::string::npos &&
            object["crs"].dump().find("4326") == std::string::npos)
            refuse_geojson(at_, "has coordinates of another reference than WGS84");
    }

    void read_feature(const Json& feature) {
        const auto first = entries.size();
        read_geometry(member(feature, "geometry", "a geometry", &Json::is_object));
        const auto properties = feature.find("properties");
        if (properties == feature.end() || !properties->is_object()) return;
        for (const auto* name : waypoint_values) {
            const auto value = properties->find(name);
            if (value == properties->end() || value->is_null()) continue;
            if (!value->is_number()) refuse_geojson(at_, fmt::format("has a '{}' that is no number", name));
            for (std::size_t i = first; i < entries.size(); ++i)
                set_value(entries[i], name, value->get<double>(), at_.where);
        }
    }

    void read_geometry(const Json& geometry) {
        const auto type = type_of(geometry);
        if (type != "Point" && type != "LineString" && type != "MultiPoint")
            refuse_geojson(at_, fmt::format("is a {}, which is no path", type));
        const auto& coordinates = member(geometry, "coordinates", "an array", &Json::is_array);
        if (type == "Point") {
            read_position(coordinates);
        } else {
            for (const auto& position : coordinates) read_position(position);
        }
    }

    /// Longitude comes first.
    void read_position(const Json& position) {
        const bool is_position = position.is_array() && (position.size() == 2 || position.size() == 3) &&
                                 std::ranges::all_of(position, [](const Json& part) { return part.is_number(); });
        if (!is_position)
            refuse_geojson(at_, "has a position that is not [longitude, latitude] or [longitude, latitude, altitude]");
        PathEntry entry;
        entry.where = at_.where;
        entry.name = fmt::format("waypoint {}", entries.size() + 1);
        entry.geographic = geographic_place(position[1].get<double>(), position[0].get<double>(), at_.where);
        if (position.size() == 3) set_value(entry, "altitude_m", position[2].get<double>(), at_.where);
        entries.push_back(std::move(entry));
    }

    PathEntry at_;  ///< where it reads: file and feature
};

std::size_t line_at(std::string_view text, std::size_t offset) {
    const auto until = text.substr(0, std::min(offset, text.size()));
    return 1 + static_cast<std::size_t>(std::ranges::count(until, '\n'));
}

/// A flight plan's waypoints.
class FlightPlanReader {
  public:
    FlightPlanReader(std::string_view text, const std::string& file) : text_(text), file_(file) {
        const auto parsed = document_.load_buffer(text.data(), text.size());
        if (!parsed) {
            const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
            throw InputError({file_, line_at(text_, offset)}, fmt::format("is not XML: {}", parsed.description()));
        }
        plan_ = document_.child("flight_plan");
        if (!plan_) throw InputError({file_}, "has no <flight_plan>", "expected a flight plan of Paparazzi");
        for (const auto& waypoint : plan_.child("waypoints").children("waypoint"))
            names_.emplace_back(waypoint.attribute("name").value());
    }

    PathEntry waypoint(const std::string& name) const {
        const auto found = plan_.child("waypoints").find_child_by_attribute("waypoint", "name", name.c_str());
        if (!found) {
            throw InputError({file_}, fmt::format("has no waypoint '{}'", name),
                             names_.empty() ? "it has no waypoints at all" : "it has " + short_list(names_));
        }
        if (std::ranges::count(names_, name) > 1) {
            throw InputError(where(found), fmt::format("there are several waypoints '{}'", name),
                             "give each a name of its own");
        }
        PathEntry entry;
        entry.name = fmt::format("waypoint {}", name);
        entry.where = where(found);
        if (has(found, "x") && has(found, "y")) {
            entry.place = LocalPosition{number(found, "x"), number(found, "y")};
        } else if (has(found, "lat") && has(found, "lon")) {
            const auto origin = geographic_place(number(plan_, "lat0"), number(plan_, "lon0"), where(plan_));
            entry.place = to_local(geographic_place(number(found, "lat"), number(found, "lon"), entry.where), origin);
        } else {
            throw InputError(entry.where, entry.name + " has no place", "expected x and y, or lat and lon");
        }
        if (const auto altitude_m = altitude_of(found)) set_value(entry, "altitude_m", *altitude_m, entry.where);
        return entry;
    }

  private:
    static bool has(const pugi::xml_node& node, const char* name) { return !node.attribute(name).empty(); }

    Location where(const pugi::xml_node& node) const {
        return {file_, line_at(text_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)))};
    }

    double number(const pugi::xml_node& node, const char* name) const {
        const std::string_view value = node.attribute(name).value();
        if (const auto parsed = parse_number(value)) return *parsed;
        throw InputError(where(node), fmt::format("{} of <{}> is no number: '{}'", name, node.name(), value),
                         "expected decimal degrees or metres");
    }

    /// Above the sea: its own, its height above the plan's ground, or the plan's.
    std::optional<double> altitude_of(const pugi::xml_node& node) const {
        if (has(node, "alt")) return number(node, "alt");
        if (has(node, "height") && has(plan_, "ground_alt"))
            return number(plan_, "ground_alt") + number(node, "height");
        if (has(plan_, "alt")) return number(plan_, "alt");
        return std::nullopt;
    }

    std::string_view text_;
    std::string file_;
    pugi::xml_document document_;
    pugi::xml_node plan_;
    std::vector<std::string> names_;
};

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
        for (const auto* name : waypoint_values) {
            const auto column = std::ranges::find(table.columns, name) - table.columns.begin();
            const auto index = static_cast<std::size_t>(column);
            if (index == table.columns.size() || row.cells[index].text.empty()) continue;
            set_value(entry, name, cell_number(table, row, index), {file, row.line, row.cells[index].column});
        }
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) throw InputError({file}, "has no waypoints");
    return entries;
}

std::vector<PathEntry> parse_geojson(std::string_view text, const std::string& file) {
    GeoJsonReader reader(file);
    try {
        reader.read(Json::parse(text));
    } catch (const Json::parse_error& error) {
        throw InputError({file, line_at(text, error.byte == 0 ? 0 : error.byte - 1)}, "is not JSON",
                         "expected GeoJSON: Points and LineStrings");
    } catch (const Json::out_of_range& error) {  // names the number in quotation marks, and no place
        std::string number = error.what();
        number = number.substr(number.find('\'') + 1);
        number = number.substr(0, number.find('\''));
        throw InputError({file, line_at(text, std::min(text.find(number), text.size()))},
                         fmt::format("a number is out of range: '{}'", number), "expected a coordinate");
    }
    if (reader.entries.empty()) throw InputError({file}, "has no waypoints");
    return std::move(reader.entries);
}

std::vector<PathEntry> read_waypoints(const std::filesystem::path& path) {
    auto ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto text = read_file(path);
    return ending == ".geojson" || ending == ".json" ? parse_geojson(text, path.string())
                                                     : parse_waypoint_csv(text, path.string());
}

std::vector<PathEntry> parse_flight_plan(std::string_view text, const std::string& file,
                                         const std::vector<std::string>& names) {
    const FlightPlanReader reader(text, file);
    std::vector<PathEntry> entries;
    entries.reserve(names.size());
    for (const auto& name : names) entries.push_back(reader.waypoint(name));
    return entries;
}

std::vector<PathEntry> read_flight_plan(const std::filesystem::path& path, const std::vector<std::string>& names) {
    return parse_flight_plan(read_file(path), path.string(), names);
}

}  // namespace flightwatt::path
