#include "flight/series_file/front_matter.h"

#include "base/error.h"
#include "base/number.h"
#include "base/toml_reader.h"
#include "base/toml_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr std::array origins{CurrentOrigin::unknown, CurrentOrigin::sensor, CurrentOrigin::throttle};

/// Counters of lines; what stands behind the last message has no time, so `time_s` is then one shorter.
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
        throw InputError(table.where(), "time_s, count and first_line are not equally long");
    }
    for (std::size_t i = 0; i < count.size(); ++i) {
        skipped.lines.push_back({i < time_s.size() ? time_s[i] : std::numeric_limits<double>::infinity(),
                                 static_cast<std::size_t>(count[i]), static_cast<std::size_t>(first_line[i])});
    }
    return skipped;
}

CurrentOrigin read_origin(const TomlTable& table) {
    const auto text = table.string("current_origin");
    for (const auto origin : origins)
        if (to_string(origin) == text) return origin;
    throw InputError(table.where("current_origin"), fmt::format("current_origin is '{}'", text),
                     "expected 'measured by a sensor', 'computed from throttle' or 'unknown'");
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
    series.current_origin = read_origin(table);
    series.planned_ground_altitude_m = table.optional_number("planned_ground_altitude_m");
    series.start_clock_s = table.optional_number("start_clock_s");
    series.log_is_missing = table.optional_boolean("lacks_log").value_or(false);
    if (table.has("notes")) series.notes = table.strings("notes");
    if (const auto names = table.optional_table("block_names")) series.block_names = read_block_names(*names);
    for (const auto& assumed : table.tables("assumed_definition")) {
        series.assumed_definitions.push_back({assumed.string("text"), assumed.number("since_s")});
        assumed.refuse_unknown_keys();
    }
    for (const auto& skipped : table.tables("skipped")) series.skipped.push_back(read_skipped(skipped));
    for (const auto& column : table.tables("column")) {
        matter.columns.push_back(column.string("name"));
        series.tracks.push_back(read_track(column));
    }
    table.refuse_unknown_keys();
    return matter;
}

}  // namespace

std::vector<std::string> column_names(const std::vector<Track>& tracks) {
    std::map<std::string, int> count;
    std::vector<std::string> names;
    for (const auto& track : tracks) {
        const int number = ++count[track.name];
        names.push_back(number == 1 ? track.name : fmt::format("{}.{}", track.name, number));
    }
    return names;
}

std::string format_front_matter(const FlightSeries& series) {
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
    if (!series.notes.empty()) toml += fmt::format("notes = {}\n", toml_strings(series.notes));
    if (!series.block_names.empty()) toml += "[block_names]\n";
    for (const auto& [number, name] : series.block_names) {
        toml += fmt::format("{} = {}\n", number, toml_string(name));
    }
    for (const auto& assumed : series.assumed_definitions) {
        toml += fmt::format("[[assumed_definition]]\ntext = {}\nsince_s = {}\n", toml_string(assumed.text),
                            toml_real(assumed.since_s));
    }
    for (const auto& skipped : series.skipped) toml += skipped_text(skipped);
    const auto columns = column_names(series.tracks);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& track = series.tracks[i];
        toml += fmt::format("[[column]]\nname = {}\nsource = {}\n", toml_string(columns[i]), toml_string(track.source));
        if (!track.device.empty()) toml += fmt::format("device = {}\n", toml_string(track.device));
        if (std::isfinite(track.since_s)) toml += fmt::format("since_s = {}\n", toml_real(track.since_s));
    }
    std::string comments;
    for (std::string_view rest = toml; !rest.empty();) {
        const auto line = rest.substr(0, rest.find('\n'));
        comments += fmt::format("# {}\n", line);
        rest.remove_prefix(line.size() + 1);
    }
    return comments;
}

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

}  // namespace flightwatt::flight
