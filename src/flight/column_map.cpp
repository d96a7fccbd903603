#include "flight/column_map.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/toml_reader.h"
#include "flight/flight_data.h"
#include "flight/series_file.h"
#include "telemetry/data_file.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <boost/algorithm/string/predicate.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {

/// The maps that come with FlightWatt: config/columns (CMakeLists.txt).
std::vector<std::string_view> shipped_column_maps();

namespace {

using Combine = MappedTrack::Combine;

double unit_factor(const TomlTable& table, const std::string& track) {
    const auto text = table.optional_string("unit");
    if (!text) return 1.0;
    const auto unit = units::parse_unit(*text);
    if (unit && unit->quantity == quantity_of(track)) return unit->factor;
    throw InputError(
        table.where("unit"), fmt::format("'{}' is no unit of {}", *text, track),
        "expected a unit such as V, mA, mW, mAh, m, ft, cm/s, km/h, mph, kt, deg, rad or %, or its factor");
}

MappedTrack read_mapped_track(const TomlTable& table) {
    MappedTrack track;
    track.name = table.string("name");
    if (std::ranges::find(track_names(), track.name) == track_names().end())
        throw InputError(
            table.where("name"), fmt::format("unknown track '{}'", track.name),
            meant_or(track.name, track_names(), fmt::format("expected {}", fmt::join(track_names(), ", "))));
    if (const auto column = table.optional_string("column")) track.columns = {*column};
    for (const auto& [key, combine, least] :
         {std::tuple{"columns", Combine::first, 1U}, {"product", Combine::product, 2U}, {"norm", Combine::norm, 1U}}) {
        if (!table.has(key)) continue;
        if (!track.columns.empty())
            throw InputError(table.where(key), fmt::format("{} has a second source", track.name), "remove one");
        track.columns = table.strings(key);
        track.combine = combine;
        if (track.columns.size() < least)
            throw InputError(table.where(key), fmt::format("expected {} or more columns", least));
    }
    const auto constant = table.optional_number("value");
    if (track.columns.empty() != constant.has_value())
        throw InputError(table.where(), fmt::format("{} has {} source", track.name, constant ? "a second" : "no"),
                         "expected one of column, columns, product, norm and value");
    track.states_unit = table.has("unit") || table.has("factor");
    track.unit_factor = unit_factor(table, track.name);
    track.factor = constant.value_or(1.0) * table.optional_number("factor").value_or(1.0);
    if (constant) track.factor *= track.unit_factor;
    table.refuse_unknown_keys();
    return track;
}

void read_time(const TomlTable& time, ColumnMap& map) {
    map.time_column = time.string("column");
    const auto text = time.optional_string("unit").value_or("s");
    const auto unit = units::parse_unit(text);
    if (!unit || unit->quantity != units::Quantity::second)
        throw InputError(time.where("unit"), fmt::format("'{}' is no unit of time", text),
                         "expected min, s, ms, us or ns");
    map.tick_s = unit->factor;
    const auto clock = time.optional_string("clock").value_or("log");
    map.is_unix_time = clock == "unix";
    if (clock != "log" && clock != "unix")
        throw InputError(time.where("clock"), fmt::format("clock is '{}', expected log or unix", clock));
    map.date_column = time.optional_string("date").value_or("");
    time.refuse_unknown_keys();
}

/// The beginning of a text, in which a header is.
std::string_view beginning_of(std::string_view csv) {
    constexpr std::size_t max_header_bytes = 1 << 16;
    return csv.substr(0, max_header_bytes);
}

bool has_all(const std::vector<std::string>& header, const std::vector<std::string>& columns) {
    return std::ranges::all_of(columns,
                               [&](const auto& column) { return std::ranges::find(header, column) != header.end(); });
}

/// Only time and tracks, further candidates included.
bool is_series_header(const std::vector<std::string>& header) {
    const auto is_known = [](const std::string& column) {
        return column == "time_s" ||
               std::ranges::find(track_names(), column.substr(0, column.find('.'))) != track_names().end();
    };
    return std::ranges::all_of(header, is_known) && has_all(header, {"time_s"}) &&
           (has_all(header, {"power_w"}) || has_all(header, {"altitude_m"}));
}

/// The maps of shipped_column_maps().
const std::vector<ColumnMap>& shipped_maps() {
    static const auto maps = [] {
        std::vector<ColumnMap> all;
        for (const auto text : shipped_column_maps()) {
            all.push_back(parse_column_map(std::string(text), "a column map of FlightWatt"));
            all.back().is_shipped = true;
        }
        return all;
    }();
    return maps;
}

}  // namespace

ColumnMap parse_column_map(const std::string& text, const std::filesystem::path& file) {
    const auto table = parse_toml(text, file.string());
    require_known_format(table);
    ColumnMap map;
    map.text = text;
    if (table.has("header")) map.header = table.strings("header");
    map.aircraft_id = table.optional_string("aircraft_id").value_or("");
    map.aircraft_name = table.optional_string("aircraft_name").value_or("");
    map.firmware = table.optional_string("firmware").value_or("");
    if (!map.firmware.empty() && map.firmware != "fixedwing" && map.firmware != "rotorcraft" && map.firmware != "rover")
        throw InputError(table.where("firmware"), fmt::format("firmware is '{}'", map.firmware),
                         "expected fixedwing, rotorcraft or rover");
    if (table.has("current_origin")) map.current_origin = read_current_origin(table);
    if (table.has("skip_lines")) map.skip_lines = count_in(table, "skip_lines");
    read_time(table.table("time"), map);
    const auto maps = [&](std::string_view name) {
        return std::ranges::find(map.tracks, name, &MappedTrack::name) != map.tracks.end();
    };
    for (const auto& track : table.tables("track")) {
        auto read = read_mapped_track(track);
        if (maps(read.name))
            throw InputError(track.where("name"), fmt::format("{} is named twice", read.name),
                             "keep one, or give it several `columns` of which files have one");
        map.tracks.push_back(std::move(read));
    }
    table.refuse_unknown_keys();
    if (!maps("power_w") && !maps("altitude_m") && !(maps("voltage_v") && maps("current_a")))
        throw InputError({file.string()}, "has neither power_w nor altitude_m", "add a [[track]] with this name");
    return map;
}

std::optional<units::Quantity> quantity_of(std::string_view track) {
    using enum units::Quantity;
    constexpr std::pair<std::string_view, units::Quantity> suffixes[] = {{"_m_per_s", metre_per_second},
                                                                         {"_percent", percent},
                                                                         {"_deg", degree},
                                                                         {"_ah", ampere_hour},
                                                                         {"_wh", watt_hour},
                                                                         {"_v", volt},
                                                                         {"_a", ampere},
                                                                         {"_w", watt},
                                                                         {"_m", metre},
                                                                         {"_c", celsius},
                                                                         {"_kg", kilogram}};
    for (const auto& [suffix, quantity] : suffixes)
        if (track.ends_with(suffix)) return quantity;
    return std::nullopt;
}

std::vector<std::string> header_names(const ColumnMap& map) {
    if (map.is_shipped) return map.header;
    std::vector<std::string> names{map.time_column};
    for (const auto& track : map.tracks) names.insert(names.end(), track.columns.begin(), track.columns.end());
    return names;
}

ColumnMap read_column_map(const std::filesystem::path& file) { return parse_column_map(read_file(file), file); }

std::optional<ColumnMap> column_map_of(std::string_view csv, const std::filesystem::path& file,
                                       const std::optional<std::filesystem::path>& columns) {
    if (csv.starts_with("# format")) return std::nullopt;
    if (columns) return read_column_map(*columns);
    csv = beginning_of(csv);
    const auto header = find_csv_header(csv, file.string(), {"time_s"});
    if (header.columns.empty() || header.has_all) return std::nullopt;
    const auto occurs = [&](const std::string& name) { return csv.find(name) != std::string_view::npos; };
    for (const auto& map : shipped_maps())
        if (!map.header.empty() && std::ranges::all_of(map.header, occurs) &&
            find_csv_header(csv, file.string(), map.header).has_all)
            return map;
    throw InputError(
        {file.string(), header.dialect.lines_before + 1}, "has no column 'time_s'",
        fmt::format("its columns are {}; name them time_s, voltage_v, current_a (or power_w), altitude_m, with "
                    "values in these units, or state which they are in a column map: --columns MAP.toml "
                    "(docs/formats.md, Column map)",
                    short_list(header.columns)));
}

bool is_flight_csv(const std::filesystem::path& file, const std::optional<std::filesystem::path>& columns) {
    constexpr const char* endings[] = {".csv", ".tsv", ".txt", ".log"};
    const auto ending = file.extension().string();
    if (std::ranges::none_of(endings, [&](const char* known) { return boost::iequals(ending, known); })) return false;
    const auto beginning = telemetry::beginning_of_file(file);
    try {
        const auto series = find_csv_header(beginning, file.string(), {"time_s"});
        if (is_series_header(series.columns)) return true;
        const auto map = column_map_of(beginning, file, columns);
        if (!map) return false;
        const auto header = find_csv_header(beginning, file.string(), header_names(*map), map->skip_lines);
        return !find_columns(header.columns, map->time_column).empty();
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace flightwatt::flight
