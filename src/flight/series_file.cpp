#include "flight/series_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "flight/families/series_table.h"
#include "flight/select.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// Counts of skipped lines; those after the last message have no time, so `time_s` is then one shorter.
std::string skipped_text(const telemetry::SkippedLines& skipped) {
    std::vector<double> time_s;
    std::vector<std::size_t> count;
    std::vector<std::size_t> first_line;
    for (const auto& at : skipped.lines) {
        if (std::isfinite(at.time_s)) time_s.push_back(at.time_s);
        count.push_back(at.count);
        first_line.push_back(at.first_line);
    }
    const auto unit = skipped.unit == telemetry::SkippedLines::Unit::line
                          ? std::string()
                          : fmt::format("unit = \"{}\"\n", to_string(skipped.unit));
    return fmt::format("[[skipped]]\nreason = {}\n{}time_s = {}\ncount = [{}]\nfirst_line = [{}]\n",
                       toml_string(skipped.reason), unit, toml_reals(time_s), fmt::join(count, ", "),
                       fmt::join(first_line, ", "));
}

telemetry::SkippedLines::Unit read_skip_unit(const std::string& text, const Location& where) {
    using Unit = telemetry::SkippedLines::Unit;
    for (const auto unit : {Unit::line, Unit::frame, Unit::byte})
        if (to_string(unit) == text) return unit;
    throw InputError(where, fmt::format("unit is '{}', expected line, frame or byte", truncated(text)));
}

telemetry::SkippedLines read_skipped(const TomlTable& table) {
    telemetry::SkippedLines skipped{table.string("reason"), {}};
    const auto time_s = table.numbers("time_s");
    const auto count = table.numbers("count");
    const auto first_line = table.numbers("first_line");
    if (const auto unit = table.optional_string("unit")) skipped.unit = read_skip_unit(*unit, table.where());
    table.refuse_unknown_keys();
    if (first_line.size() != count.size() || time_s.size() > count.size() || time_s.size() + 1 < count.size()) {
        throw InputError(table.where(), "time_s, count and first_line have different lengths");
    }
    for (std::size_t i = 0; i < count.size(); ++i) {
        skipped.lines.push_back({i < time_s.size() ? time_s[i] : std::numeric_limits<double>::infinity(),
                                 static_cast<std::size_t>(count[i]), static_cast<std::size_t>(first_line[i])});
    }
    return skipped;
}

Track read_track(const TomlTable& table) {
    Track track;
    const auto column = table.string("name");
    track.name = column.substr(0, column.find('.'));
    track.source = table.string("source");
    track.device = table.optional_string("device").value_or("");
    if (const auto since_s = table.optional_number("since_s")) track.since_s = *since_s;
    table.refuse_unknown_keys();
    return track;
}

std::map<int, std::string> read_block_names(const TomlTable& table) {
    std::map<int, std::string> names;
    for (const auto& key : table.keys()) {
        const auto number = parse_unsigned(key);
        if (!number) throw InputError(table.where(key), fmt::format("block '{}' is not a number", key));
        names[static_cast<int>(*number)] = table.string(key);
    }
    return names;
}

FrontMatter read_matter(const TomlTable& table) {
    FrontMatter matter;
    auto& series = matter.series;
    series.flight = table.string("flight");
    series.aircraft_id = table.string("aircraft_id");
    series.aircraft_name = table.string("aircraft_name");
    series.firmware = table.optional_string("firmware").value_or("");
    series.current_origin = read_current_origin(table);
    series.planned_ground_altitude_m = table.optional_number("planned_ground_altitude_m");
    series.start_clock_s = table.optional_number("start_clock_s");
    series.log_is_missing = table.optional_boolean("lacks_log").value_or(false);
    if (table.has("notes")) series.notes = table.strings("notes");
    if (const auto names = table.optional_table("block_names")) series.block_names = read_block_names(*names);
    series.pack_serial = table.optional_string("pack_serial").value_or("");
    series.pack_cycles = table.optional_number("pack_cycles");
    if (const auto kinds = table.optional_table("monitor_kinds"))
        for (const auto& id : kinds->keys()) series.monitor_kinds[id] = kinds->string(id);
    if (const auto capacities = table.optional_table("monitor_capacities_ah"))
        for (const auto& id : capacities->keys()) series.monitor_capacities_ah[id] = capacities->number(id);
    for (const auto& assumed : table.tables("assumed_definition")) {
        series.assumed_definitions.push_back({assumed.string("text"), assumed.number("since_s")});
        assumed.refuse_unknown_keys();
    }
    for (const auto& skipped : table.tables("skipped")) series.skipped.push_back(read_skipped(skipped));
    for (const auto& column : table.tables("column")) {
        const auto name = column.string("name");
        const bool is_chosen = column.optional_boolean("chosen").value_or(false);
        auto track = read_track(column);
        if (is_chosen) {
            matter.chosen_column = name;
            continue;
        }
        matter.columns.push_back(name);
        series.tracks.push_back(std::move(track));
    }
    table.refuse_unknown_keys();
    return matter;
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

/// The tracks of the file: those of the series, behind the power that is chosen if that is not the first candidate.
struct FileTracks {
    std::vector<Track> tracks;
    bool has_chosen = false;  ///< the first one is not of the series
};

FileTracks file_tracks(const FlightSeries& series) {
    FileTracks file{series.tracks};
    const auto first = std::ranges::find(series.tracks, "power_w", &Track::name);
    if (first == series.tracks.end()) return file;
    Track power = select_tracks(series).power_w;
    if (power.empty() || (power.source == first->source && power.device == first->device)) return file;
    file.tracks.insert(file.tracks.begin(), std::move(power));
    file.has_chosen = true;
    return file;
}

/// The metadata as comment lines of TOML: `# format = 1` ...
std::string format_front_matter(const FlightSeries& series, const FileTracks& file) {
    std::string toml = format_line();
    toml += fmt::format("flight = {}\naircraft_id = {}\naircraft_name = {}\n", toml_string(series.flight),
                        toml_string(series.aircraft_id), toml_string(series.aircraft_name));
    if (!series.firmware.empty()) toml += fmt::format("firmware = {}\n", toml_string(series.firmware));
    toml += fmt::format("current_origin = {}\n", toml_string(to_string(series.current_origin)));
    if (const auto ground_m = series.planned_ground_altitude_m) {
        toml += fmt::format("planned_ground_altitude_m = {}\n", toml_real(*ground_m));
    }
    if (series.start_clock_s) toml += fmt::format("start_clock_s = {}\n", toml_real(*series.start_clock_s));
    if (series.log_is_missing) toml += "lacks_log = true\n";
    if (!series.pack_serial.empty()) toml += fmt::format("pack_serial = {}\n", toml_string(series.pack_serial));
    if (series.pack_cycles) toml += fmt::format("pack_cycles = {}\n", toml_real(*series.pack_cycles));
    if (!series.notes.empty()) toml += fmt::format("notes = {}\n", toml_strings(series.notes));
    if (!series.block_names.empty()) toml += "[block_names]\n";
    for (const auto& [number, name] : series.block_names) {
        toml += fmt::format("{} = {}\n", number, toml_string(name));
    }
    if (!series.monitor_kinds.empty()) toml += "[monitor_kinds]\n";
    for (const auto& [id, kind] : series.monitor_kinds) toml += fmt::format("{} = {}\n", id, toml_string(kind));
    if (!series.monitor_capacities_ah.empty()) toml += "[monitor_capacities_ah]\n";
    for (const auto& [id, capacity_ah] : series.monitor_capacities_ah)
        toml += fmt::format("{} = {}\n", id, toml_real(capacity_ah));
    for (const auto& assumed : series.assumed_definitions) {
        toml += fmt::format("[[assumed_definition]]\ntext = {}\nsince_s = {}\n", toml_string(assumed.text),
                            toml_real(assumed.since_s));
    }
    for (const auto& skipped : series.skipped) toml += skipped_text(skipped);
    const auto columns = column_names(file.tracks);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& track = file.tracks[i];
        toml += fmt::format("[[column]]\nname = {}\nsource = {}\n", toml_string(columns[i]), toml_string(track.source));
        if (i == 0 && file.has_chosen) toml += "chosen = true\n";
        if (!track.device.empty()) toml += fmt::format("device = {}\n", toml_string(track.device));
        if (std::isfinite(track.since_s)) toml += fmt::format("since_s = {}\n", toml_real(track.since_s));
    }
    toml.pop_back();
    return fmt::format("# {}\n", boost::algorithm::replace_all_copy(toml, "\n", "\n# "));
}

/// Throws InputError for a newer format, and for metadata that format_front_matter does not write.
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
    auto matter = read_matter(table);
    matter.present = true;
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
    auto recordings = read_series_table(read_front_matter(text, file.string()), text, file.string(), plain_source);
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
    const auto text = table.string("current_origin");
    for (const auto origin : {CurrentOrigin::unknown, CurrentOrigin::sensor, CurrentOrigin::throttle})
        if (to_string(origin) == text) return origin;
    throw InputError(table.where("current_origin"), fmt::format("current_origin is '{}'", text),
                     "expected 'measured by a sensor', 'computed from throttle' or 'unknown'");
}

std::string to_csv(const FlightSeries& series) {
    std::string text;
    write_csv(series, [&](std::string_view chunk) { text += chunk; });
    return text;
}

void write_csv(const FlightSeries& series, const TextSink& sink) {
    const auto file = file_tracks(series);
    sink(fmt::format("{}time_s,{}\n", format_front_matter(series, file), fmt::join(column_names(file.tracks), ",")));
    write_rows(file.tracks, sink);
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

FlightSeries read_series_csv(const std::filesystem::path& path) { return parse_series_csv(read_file(path), path); }

}  // namespace flightwatt::flight
