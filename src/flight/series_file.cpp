#include "flight/series_file.h"

#include "base/error.h"
#include "base/number.h"
#include "base/toml_fields.h"
#include "flight/families/series_table.h"
#include "flight/select.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr CurrentOrigin current_origins[] = {CurrentOrigin::unknown, CurrentOrigin::sensor, CurrentOrigin::throttle};

/// Counts of skipped lines; those after the last message have no time, so `time_s` is then one shorter.
void list_skipped(TomlFields& fields, telemetry::SkippedLines& skipped) {
    using Unit = telemetry::SkippedLines::Unit;
    std::vector<double> time_s;
    std::vector<std::size_t> count;
    std::vector<std::size_t> first_line;
    for (const auto& at : skipped.lines) {
        if (std::isfinite(at.time_s)) time_s.push_back(at.time_s);
        count.push_back(at.count);
        first_line.push_back(at.first_line);
    }
    fields.text("reason", skipped.reason);
    if (fields.has("unit", skipped.unit != Unit::line))
        fields.choice("unit", skipped.unit, {Unit::line, Unit::frame, Unit::byte});
    fields.reals("time_s", time_s);
    fields.counts("count", count);
    fields.counts("first_line", first_line);
    if (fields.source() == nullptr) return;
    if (first_line.size() != count.size() || time_s.size() > count.size() || time_s.size() + 1 < count.size())
        throw InputError(fields.source()->where(), "time_s, count and first_line have different lengths");
    for (std::size_t i = 0; i < count.size(); ++i)
        skipped.lines.push_back(
            {i < time_s.size() ? time_s[i] : std::numeric_limits<double>::infinity(), count[i], first_line[i]});
}

void list_block_names(TomlFields& fields, std::map<int, std::string>& names) {
    if (const auto* table = fields.source())
        for (const auto& key : table->keys()) {
            const auto number = parse_unsigned(key);
            if (!number) throw InputError(table->where(key), fmt::format("block '{}' is not a number", key));
            names[static_cast<int>(*number)] = table->string(key);
        }
    for (auto& [number, name] : names) fields.text(std::to_string(number), name);
}

/// Lists a table whose keys are those of a map.
template <typename Value>
void list_by_id(TomlFields& fields, std::map<std::string, Value>& values) {
    if (fields.source() != nullptr)
        for (const auto& id : fields.source()->keys()) values[id];
    for (auto& [id, value] : values)
        if constexpr (std::is_same_v<Value, double>)
            fields.real(id, value);
        else
            fields.text(id, value);
}

/// A column without its values.
struct Column {
    std::string name;
    bool is_chosen = false;  ///< it repeats the chosen one of the others
    Track track;
};

void list_column(TomlFields& fields, Column& column) {
    fields.text("name", column.name);
    fields.text("source", column.track.source);
    fields.optional_flag("chosen", column.is_chosen);
    fields.optional_text("device", column.track.device);
    if (fields.has("since_s", std::isfinite(column.track.since_s))) fields.real("since_s", column.track.since_s);
}

void list_columns(TomlFields& fields, FrontMatter& matter) {
    std::vector<Column> columns;
    for (std::size_t i = 0; i < matter.series.tracks.size(); ++i) {
        const auto& track = matter.series.tracks[i];
        const bool is_chosen = i == 0 && !matter.chosen_column.empty();
        columns.push_back(
            {matter.columns[i], is_chosen, {.source = track.source, .device = track.device, .since_s = track.since_s}});
    }
    fields.tables("column", columns, list_column, "");
    if (fields.source() == nullptr) return;
    for (auto& [name, is_chosen, track] : columns) {
        if (is_chosen) {
            matter.chosen_column = name;
            continue;
        }
        track.name = name.substr(0, name.find('.'));
        matter.columns.push_back(name);
        matter.series.tracks.push_back(std::move(track));
    }
}

void list_matter(TomlFields& fields, FrontMatter& matter) {
    auto& series = matter.series;
    fields.text("flight", series.flight);
    fields.text("aircraft_id", series.aircraft_id);
    fields.text("aircraft_name", series.aircraft_name);
    fields.optional_text("firmware", series.firmware);
    if (fields.has("current_origin", true)) fields.choice("current_origin", series.current_origin, current_origins);
    fields.optional_real("planned_ground_altitude_m", series.planned_ground_altitude_m);
    fields.optional_real("start_clock_s", series.start_clock_s);
    fields.optional_flag("lacks_log", series.log_is_missing);
    fields.optional_text("pack_serial", series.pack_serial);
    fields.optional_real("pack_cycles", series.pack_cycles);
    fields.optional_real("motors", series.motors);
    if (fields.has("notes", !series.notes.empty())) fields.texts("notes", series.notes);
    const auto section = [&](std::string_view key, auto& entries, const auto& list) {
        if (fields.has(key, !entries.empty())) fields.table(key, entries, list, TomlLayout::section);
    };
    section("block_names", series.block_names, list_block_names);
    section("monitor_kinds", series.monitor_kinds, list_by_id<std::string>);
    section("monitor_capacities_ah", series.monitor_capacities_ah, list_by_id<double>);
    section("monitor_cells", series.monitor_cells, list_by_id<double>);
    const auto list_assumed = [](TomlFields& of, telemetry::AssumedDefinition& assumed) {
        of.text("text", assumed.text);
        of.real("since_s", assumed.since_s);
    };
    fields.tables("assumed_definition", series.assumed_definitions, list_assumed, "");
    fields.tables("skipped", series.skipped, list_skipped, "");
    list_columns(fields, matter);
}

/// Names of the columns: NAME of the first candidate of each name, NAME.2, NAME.3 ... of the others.
std::vector<std::string> column_names(const std::vector<Track>& tracks) {
    std::map<std::string, int> count;
    std::vector<std::string> names;
    for (const auto& track : tracks) {
        const int number = ++count[track.name];
        names.push_back(number == 1 ? track.name : fmt::format("{}.{}", track.name, number));
    }
    return names;
}

/// The file of a series: its tracks behind the power that is chosen, if that is not the first candidate.
FrontMatter file_of(const FlightSeries& series) {
    FrontMatter file{true, series, {}};
    auto& tracks = file.series.tracks;
    const auto first = std::ranges::find(tracks, "power_w", &Track::name);
    auto power = first != tracks.end() ? select_tracks(series).power_w : Track();
    if (!power.empty() && (power.source != first->source || power.device != first->device)) {
        tracks.insert(tracks.begin(), std::move(power));
        file.chosen_column = "power_w";
    }
    file.columns = column_names(tracks);
    return file;
}

/// The metadata as comment lines of TOML: `# format = 1` ...
std::string format_front_matter(FrontMatter& file) {
    TomlFields fields("");
    list_matter(fields, file);
    return fmt::format("# {}\n", boost::algorithm::replace_all_copy(format_line() + fields.lines(), "\n", "\n# "));
}

/// Throws InputError for a newer format, and for metadata that list_matter does not list.
FrontMatter read_front_matter(std::string_view text, const std::string& file) {
    std::string toml;
    bool is_ours = false;
    while (text.starts_with('#')) {
        auto line = text.substr(1, text.find('\n') - 1);
        text.remove_prefix(std::min(line.size() + 2, text.size()));
        if (line.starts_with(' ')) line.remove_prefix(1);
        is_ours = is_ours || (toml.empty() && line.starts_with("format"));
        toml += line;
        toml += '\n';
    }
    if (!is_ours) return {};
    const auto table = parse_toml(toml, file);
    require_known_format(table);
    FrontMatter matter{true, {}, {}};
    TomlFields fields(table);
    list_matter(fields, matter);
    table.refuse_unknown_keys();
    return matter;
}

/// Writes a row for each time at which any track has a value, with a cell for each track.
void write_rows(const std::vector<Track>& tracks, const TextSink& sink) {
    constexpr std::size_t chunk_size = 1 << 16;
    constexpr double infinite_s = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> next(tracks.size(), 0);  // index of each track's next value
    const auto next_s = [&](std::size_t k) {
        return next[k] == tracks[k].time_s.size() ? infinite_s : tracks[k].time_s[next[k]];
    };
    std::string text;
    while (true) {
        double time_s = infinite_s;
        for (std::size_t k = 0; k < tracks.size(); ++k) time_s = std::min(time_s, next_s(k));
        if (!std::isfinite(time_s)) break;
        fmt::format_to(std::back_inserter(text), "{}", time_s);
        for (std::size_t k = 0; k < tracks.size(); ++k) {
            text += ',';
            if (next_s(k) == time_s) fmt::format_to(std::back_inserter(text), "{}", tracks[k].value[next[k]++]);
        }
        text += '\n';
        if (text.size() < chunk_size) continue;
        sink(text);
        text.clear();
    }
    sink(text);
}

/// Where the front matter of a file begins that was appended; the text's size without one.
std::size_t end_of_part(std::string_view text) {
    constexpr std::string_view front = "\n# format = ";
    for (auto at = text.find(front); at != std::string_view::npos; at = text.find(front, at + 1))
        if (text[text.substr(0, at).rfind('\n') + 1] != '#') return at + 1;
    return text.size();
}

std::vector<FlightSeries> parse_part(std::string_view text, const std::filesystem::path& file) {
    auto recordings = read_series_table(read_front_matter(text, file.string()), text, file.string());
    for (auto& series : recordings) {
        series.file = file.string();
        if (series.flight.empty()) series.flight = telemetry::flight_name(file);
    }
    return recordings;
}

void require_samples(const FlightSeries& series) {
    const auto samples = [&](std::string_view name) {
        std::size_t most = 0;
        for (const auto& track : series.tracks)
            if (track.name == name) most = std::max(most, track.time_s.size());
        return most;
    };
    const bool is_flight = samples("power_w") >= 2 || (samples("power_w") == 0 && samples("altitude_m") >= 2);
    if (!is_flight) throw InputError({series.file}, "has fewer than two samples");
}

}  // namespace

CurrentOrigin read_current_origin(const TomlTable& table) {
    auto origin = CurrentOrigin::unknown;
    TomlFields(table).choice("current_origin", origin, current_origins);
    return origin;
}

std::string to_csv(const FlightSeries& series) {
    std::string text;
    write_csv(series, [&](std::string_view chunk) { text += chunk; });
    return text;
}

void write_csv(const FlightSeries& series, const TextSink& sink) {
    auto file = file_of(series);
    sink(fmt::format("{}time_s,{}\n", format_front_matter(file), fmt::join(file.columns, ",")));
    write_rows(file.series.tracks, sink);
}

std::vector<FlightSeries> parse_series_recordings(std::string_view text, const std::filesystem::path& file) {
    std::vector<FlightSeries> recordings;
    std::size_t line = 0;
    do {
        const auto part = text.substr(0, end_of_part(text));
        try {
            std::ranges::move(parse_part(part, file), std::back_inserter(recordings));
        } catch (const InputError& error) {
            auto where = error.where();
            if (where.line > 0) where.line += line;
            throw InputError(where, error.what(), error.hint());
        }
        line += static_cast<std::size_t>(std::ranges::count(part, '\n'));
        text.remove_prefix(part.size());
    } while (!text.empty());
    if (recordings.size() == 1) require_samples(recordings.front());
    return recordings;
}

FlightSeries parse_series_csv(std::string_view text, const std::filesystem::path& file) {
    auto recordings = parse_series_recordings(text, file);
    if (recordings.size() > 1)
        throw InputError({file.string()}, fmt::format("has {} recordings, expected one", recordings.size()));
    return std::move(recordings.front());
}

FlightSeries read_series_csv(const std::filesystem::path& path) {
    return parse_series_csv(read_file(path, max_series_bytes), path);
}

}  // namespace flightwatt::flight
