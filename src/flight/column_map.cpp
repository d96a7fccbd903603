#include "flight/column_map.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "flight/series_file.h"
#include "flight/sources/log_family.h"
#include "flight/telemetry_series.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {

/// The maps that come with FlightWatt: config/columns (CMakeLists.txt).
std::vector<std::string_view> shipped_column_maps();

namespace {

using Combine = MappedTrack::Combine;

/// The quantity of a track by the suffix of its name; std::nullopt for states.
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

/// Counters, angles and states are not averaged.
Merge merge_of(std::string_view track) {
    constexpr std::string_view averaged[] = {"_v", "_a", "_w", "_m", "_m_per_s", "_percent", "_c", "_rpm"};
    const bool is_mean = std::ranges::any_of(averaged, [&](auto suffix) { return track.ends_with(suffix); });
    return is_mean ? Merge::mean : Merge::latest;
}

double unit_factor(const TomlTable& table, const std::string& track) {
    const auto text = table.optional_string("unit");
    if (!text) return 1.0;
    const auto unit = units::parse_unit(*text);
    if (unit && unit->quantity == quantity_of(track)) return unit->factor;
    throw InputError(table.where("unit"), fmt::format("'{}' is no unit of {}", *text, track),
                     "expected a unit such as V, mA, W, m, cm/s, deg, rad or %");
}

MappedTrack read_track(const TomlTable& table) {
    MappedTrack track;
    track.name = table.string("name");
    if (std::ranges::find(track_names(), track.name) == track_names().end()) {
        const auto near = nearest_word(track.name, track_names());
        throw InputError(table.where("name"), fmt::format("unknown track '{}'", track.name),
                         near.empty() ? fmt::format("expected {}", fmt::join(track_names(), ", "))
                                      : fmt::format("did you mean '{}'?", near));
    }
    if (const auto column = table.optional_string("column")) track.columns = {*column};
    for (const auto& [key, combine] : {std::pair{"product", Combine::product}, {"norm", Combine::norm}}) {
        if (!table.has(key)) continue;
        if (!track.columns.empty())
            throw InputError(table.where(key), fmt::format("{} has a second source", track.name), "remove one");
        track.columns = table.strings(key);
        track.combine = combine;
        if (track.columns.size() < 2) throw InputError(table.where(key), "expected two columns or more");
    }
    const auto constant = table.optional_number("value");
    if (track.columns.empty() != constant.has_value())
        throw InputError(table.where(), fmt::format("{} has {} source", track.name, constant ? "a second" : "no"),
                         "expected one of column, product, norm and value");
    track.factor =
        constant.value_or(1.0) * unit_factor(table, track.name) * table.optional_number("factor").value_or(1.0);
    table.refuse_unknown_keys();
    return track;
}

void read_time(const TomlTable& time, ColumnMap& map) {
    constexpr std::pair<std::string_view, double> ticks[] = {{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}};
    map.time_column = time.string("column");
    const auto unit = time.optional_string("unit").value_or("s");
    const auto* const found = std::ranges::find(ticks, unit, &std::pair<std::string_view, double>::first);
    if (found == std::end(ticks))
        throw InputError(time.where("unit"), fmt::format("'{}' is no unit of time", unit), "expected s, ms, us or ns");
    map.ticks_per_s = found->second;
    const auto clock = time.optional_string("clock").value_or("log");
    map.is_unix_time = clock == "unix";
    if (clock != "log" && clock != "unix")
        throw InputError(time.where("clock"), fmt::format("clock is '{}', expected log or unix", clock));
    time.refuse_unknown_keys();
}

/// The first line that is no comment, as cells.
std::vector<std::string> header_of(std::string_view csv) {
    constexpr std::size_t max_header_bytes = 1 << 16;
    csv = csv.substr(0, max_header_bytes);
    while (csv.starts_with('#') || csv.starts_with('\n') || csv.starts_with("\r\n"))
        csv.remove_prefix(std::min(csv.find('\n'), csv.size() - 1) + 1);
    std::vector<std::string> cells;
    if (csv.empty()) return cells;
    for_each_csv_row(csv.substr(0, csv.find('\n')), "", [&](const CsvRowView& row) {
        for (const auto& cell : row.cells) cells.emplace_back(cell.text);
    });
    return cells;
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

/// Collects the raw rows of the tracks.
class MappedRows {
  public:
    MappedRows(const ColumnMap& map, std::string file)
        : map_(map), file_(std::move(file)), rows_{"row", {}, std::vector<telemetry::Column>(map.tracks.size())} {}

    void read_row(const CsvRowView& row) {
        const bool is_header = places_.empty() || row.cells[time_place_].text == map_.time_column;
        if (is_header) return bind(row);  // also of a file that was appended
        const double time_s = number(row, time_place_, 0.0) / map_.ticks_per_s;
        if (std::isnan(time_s)) return;
        rows_.time_s.push_back(time_s);
        rows_.places.push_back(row.line);
        for (std::size_t t = 0; t < places_.size(); ++t) {
            double value = map_.tracks[t].combine == Combine::norm ? 0.0 : 1.0;
            for (const auto place : places_[t]) {
                const double cell = number(row, place, time_s);
                value = map_.tracks[t].combine == Combine::norm ? std::hypot(value, cell) : value * cell;
            }
            rows_.columns[t].values.push_back(value * map_.tracks[t].factor);
        }
    }

    /// A series for each recording.
    std::vector<FlightSeries> take() {
        telemetry::TelemetryLog log{file_, "", {}, {{"", {std::move(rows_)}}}, {}, {}, 0};
        if (!skipped_.lines.empty()) log.skipped.push_back(std::move(skipped_));
        std::vector<FlightSeries> recordings;
        for (auto& recording : recordings_of(std::move(log))) recordings.push_back(series_of(std::move(recording)));
        return recordings;
    }

    std::size_t rows() const { return rows_.time_s.size(); }

  private:
    FlightSeries series_of(telemetry::TelemetryLog log) const {
        using AtTime = telemetry::SkippedLines::AtTime;
        FlightSeries series;
        series.clock_restart = find_clock_restart(log.senders.front());
        auto& [message, time_s, columns, places] = log.senders.front().tables.front();
        if (map_.is_unix_time) {
            series.start_clock_s = time_s.front();
            for (auto& time : time_s) time -= *series.start_clock_s;
            for (auto& skipped : log.skipped)
                for (auto& at : skipped.lines) at.time_s -= *series.start_clock_s;
        }
        for (std::size_t t = 0; t < columns.size(); ++t) {
            const auto& mapped = map_.tracks[t];
            auto track = make_track(time_s, columns[t].values, merge_of(mapped.name));
            track.name = mapped.name;
            track.source = mapped.columns.empty()            ? "column map"
                           : mapped.combine == Combine::norm ? fmt::format("|{}|", fmt::join(mapped.columns, ", "))
                                                             : fmt::format("{}", fmt::join(mapped.columns, " * "));
            series.tracks.push_back(std::move(track));
        }
        sort_tracks(series.tracks);
        series.skipped = std::move(log.skipped);
        for (auto& skipped : series.skipped) std::ranges::stable_sort(skipped.lines, {}, &AtTime::time_s);
        return series;
    }

    void bind(const CsvRowView& header) {
        CsvTable table{file_, {}, {}};
        for (const auto& cell : header.cells) table.columns.emplace_back(cell.text);
        time_place_ = column_index(table, map_.time_column);
        places_.clear();
        for (const auto& track : map_.tracks) {
            auto& places = places_.emplace_back();
            for (const auto& column : track.columns) places.push_back(column_index(table, column));
        }
    }

    /// NaN for an empty cell and one that is no number; the latter is counted.
    double number(const CsvRowView& row, std::size_t place, double time_s) {
        const auto& text = row.cells[place].text;
        const double value = number_or_nan(text);
        if (!std::isnan(value) || text.empty()) return value;
        auto& lines = skipped_.lines;
        if (!lines.empty() && lines.back().first_line == row.line)
            ++lines.back().count;
        else
            lines.push_back({time_s, 1, row.line});
        return value;
    }

    const ColumnMap& map_;
    std::string file_;
    std::size_t time_place_ = 0;
    std::vector<std::vector<std::size_t>> places_;  ///< of the columns of each track
    telemetry::MessageTable rows_;                  ///< a column for each track
    telemetry::SkippedLines skipped_{"cells that are no numbers", {}, telemetry::SkippedLines::Unit::line};
};

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
    read_time(table.table("time"), map);
    for (const auto& track : table.tables("track")) map.tracks.push_back(read_track(track));
    table.refuse_unknown_keys();
    const auto maps = [&](const char* name) {
        return std::ranges::find(map.tracks, name, &MappedTrack::name) != map.tracks.end();
    };
    if (!maps("power_w") && !maps("altitude_m"))
        throw InputError({file.string()}, "has neither power_w nor altitude_m", "add a [[track]] with this name");
    return map;
}

ColumnMap read_column_map(const std::filesystem::path& file) { return parse_column_map(read_file(file), file); }

std::optional<ColumnMap> column_map_of(std::string_view csv, const std::filesystem::path& file,
                                       const std::optional<std::filesystem::path>& columns) {
    if (csv.starts_with("# format")) return std::nullopt;
    if (columns) return read_column_map(*columns);
    const auto header = header_of(csv);
    if (header.empty() || has_all(header, {"time_s"})) return std::nullopt;
    for (const auto shipped : shipped_column_maps()) {
        auto map = parse_column_map(std::string(shipped), "a column map of FlightWatt");
        if (!map.header.empty() && has_all(header, map.header)) return map;
    }
    throw InputError(
        {file.string(), 1}, "has no column 'time_s'",
        fmt::format("its columns are {}; a column map names their tracks: --columns MAP.toml", short_list(header)));
}

bool is_flight_csv(const std::filesystem::path& file, const std::optional<std::filesystem::path>& columns) {
    const auto beginning = telemetry::beginning_of_file(file);
    try {
        const auto header = header_of(beginning);
        if (is_series_header(header)) return true;
        const auto map = column_map_of(beginning, file, columns);
        return map && has_all(header, {map->time_column});
    } catch (const InputError&) {
        return false;
    }
}

std::vector<FlightSeries> parse_mapped_csv(std::string_view csv, const std::filesystem::path& file,
                                           const ColumnMap& map) {
    MappedRows rows(map, file.string());
    for_each_csv_row(csv, file.string(), [&](const CsvRowView& row) { rows.read_row(row); });
    if (rows.rows() < 2) throw InputError({file.string()}, "has fewer than two rows with a time");
    auto recordings = rows.take();
    for (auto& series : recordings) {
        series.file = file.string();
        series.flight = telemetry::flight_name(file);
        series.aircraft_id = map.aircraft_id;
        series.aircraft_name = map.aircraft_name;
        series.firmware = map.firmware;
        series.current_origin = map.current_origin;
    }
    return recordings;
}

}  // namespace flightwatt::flight
