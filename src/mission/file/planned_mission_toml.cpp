#include "base/text.h"
#include "base/toml_reader.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace flightwatt::mission {
namespace {

struct Line {
    std::string text;
    bool is_kept = true;
};

std::vector<Line> lines_of(std::string_view text) {
    std::vector<Line> lines;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size());
        lines.push_back({std::string(text.substr(0, end))});
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

char first_character(const std::string& line) {
    const auto at = line.find_first_not_of(" \t\r");
    return at == std::string::npos ? '\0' : line[at];
}

bool is_blank(const std::string& line) { return first_character(line) == '\0'; }
bool is_comment(const std::string& line) { return first_character(line) == '#'; }
bool is_header(const std::string& line) { return first_character(line) == '['; }

/// The section that begins at `header` up to the next, without the comments that stand apart at its end.
void drop_section(std::vector<Line>& lines, std::size_t header) {
    auto end = header + 1;
    while (end < lines.size() && !is_header(lines[end].text)) ++end;
    auto last = end;
    while (last > header + 1 && (is_blank(lines[last - 1].text) || is_comment(lines[last - 1].text))) --last;
    while (last < end && is_comment(lines[last].text)) ++last;  // directly below its last key
    if (last == end && end < lines.size()) {                    // or directly above the next header, which it is of
        while (last > header + 1 && is_comment(lines[last - 1].text)) --last;
    }
    auto first = header;
    while (first > 0 && is_comment(lines[first - 1].text)) --first;
    for (auto i = first; i < last; ++i) lines[i].is_kept = false;
    if (first > 0 && last < lines.size() && is_blank(lines[first - 1].text) && is_blank(lines[last].text))
        lines[last].is_kept = false;
}

void drop_schedule(std::vector<Line>& lines) {
    static const std::regex of_header(R"(^\s*\[\[?\s*(plan|policy|schedule)\s*(\.|\]).*)");
    static const std::regex of_key(R"(^\s*(plan|policy|schedule)\s*(\.|=).*)");
    bool in_root = true;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        in_root = in_root && !is_header(lines[i].text);
        if (std::regex_match(lines[i].text, of_header)) drop_section(lines, i);
        if (in_root && std::regex_match(lines[i].text, of_key)) lines[i].is_kept = false;
    }
}

/// Puts the text of `wanted` where `read` stands in the line, quoted on one line.
void rename_file(std::vector<Line>& lines, const toml::value<std::string>& read, const std::string& wanted) {
    const auto place = read.source().begin;
    if (place.line < 1 || place.line > lines.size()) return;
    auto& line = lines[place.line - 1].text;
    const std::size_t start = place.column - 1;
    if (start >= line.size() || (line[start] != '"' && line[start] != '\'')) return;
    const auto end = line.find(line[start], start + 1);
    if (end == std::string::npos) return;
    line.replace(start, end + 1 - start, toml_string(wanted));
}

/// Follows both tables and renames what differs in a text.
void rename_files(std::vector<Line>& lines, const toml::table& read, const toml::table& wanted) {
    for (auto&& [key, node] : read) {
        const auto* other = wanted.get(key.str());
        if (other == nullptr) continue;
        if (const auto* table = node.as_table(); table != nullptr && other->is_table()) {
            rename_files(lines, *table, *other->as_table());
        } else if (const auto* text = node.as_string(); text != nullptr && other->is_string()) {
            if (text->get() != other->as_string()->get()) rename_file(lines, *text, other->as_string()->get());
        }
    }
}

std::string joined(const std::vector<Line>& lines) {
    std::string text;
    for (const auto& line : lines)
        if (line.is_kept) text += line.text + "\n";
    while (text.ends_with("\n\n")) text.pop_back();
    return text;
}

/// Without a byte order mark, and with the line ends of Unix.
std::string normalise_text(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    std::string plain;
    plain.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i)
        if (!text.substr(i).starts_with("\r\n")) plain += text[i];
    return plain;
}

/// The text of a mission file that says what `wanted` says, with its comments, its order and its numbers as they were
/// written: without its plan, policy and schedule and the comments directly above and in them, with other names of
/// files, and with a format if it had none. `read` is what `text`, a plain one, says. std::nullopt for a text that is
/// written in a way that this does not follow; what it gives was read again and says what `wanted` says.
std::optional<std::string> edit_keeping_comments(std::string_view text, const toml::table& read,
                                                 const toml::table& wanted) {
    auto lines = lines_of(text);
    rename_files(lines, read, wanted);
    drop_schedule(lines);
    auto kept = joined(lines);
    if (!read.contains("format") && wanted.contains("format")) {
        const auto version = wanted["format"].value_or<std::int64_t>(0);
        std::size_t at = 0;  // below the comments that the file begins with
        while (at < kept.size() && kept[at] == '#') at = kept.find('\n', at) + 1;
        kept.insert(at, fmt::format("format = {}\n", version));
    }
    try {
        if (toml::parse(kept) == wanted) return kept;
    } catch (const toml::parse_error&) {
        // a section that was written in a way not looked for
    }
    return std::nullopt;
}

/// As it was named where the working folder is gone.
std::filesystem::path absolute_path(const std::filesystem::path& path) {
    std::error_code error;
    auto absolute = std::filesystem::absolute(path, error);
    return error ? path : absolute;
}

/// Rewrites the file name that a key of `table` holds, if it does.
void move_path(toml::table& table, std::string_view key, const std::filesystem::path& from,
               const std::filesystem::path& to) {
    auto* value = table.get_as<std::string>(key);
    if (value == nullptr || (key == "mechanical" && value->get() == "none")) return;
    const std::filesystem::path named = value->get();
    if (named.is_absolute()) return;
    std::error_code error;
    const auto near = std::filesystem::proximate(from / named, to, error);
    *value = (error ? from / named : near).generic_string();  // what cannot be followed is left where it is
}

std::string run_text(const compute::ComputeModel& compute, const compute::Configuration& run) {
    std::vector<std::string> components;
    for (const auto& running : run) {
        const auto& component = compute.components.at(running.component);
        std::vector<std::string> qos;
        for (std::size_t i = 0; i < running.qos.size(); ++i)
            qos.push_back(toml_key(component.profile.parameters[i]) + " = " + toml_real(running.qos[i]));
        components.push_back(toml_key(component.name) + " = " + toml_inline_table(qos));
    }
    return toml_inline_table(components);
}

std::string schedule_text(const compute::ComputeModel& compute, const Schedule& schedule) {
    std::string text;
    for (const auto& segment : schedule) {
        text += fmt::format("\n[[schedule]]\nphase = {}\nfrom = {}\nto = {}\nrun = {}\n",
                            toml_string(to_string(segment.phase)), toml_real(segment.start_s), toml_real(segment.end_s),
                            run_text(compute, segment.run));
    }
    return text;
}

}  // namespace

PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder) {
    const auto plain = normalise_text(text);
    const auto read = toml::parse(plain, path.string());
    auto root = read;
    root.insert_or_assign("format", format_version);
    root.erase("plan");
    root.erase("schedule");
    root.erase("policy");  // the schedule is decided
    const auto from = absolute_path(path).parent_path();
    const auto to = absolute_path(folder);
    for (const std::string_view key : {"mechanical", "battery"}) move_path(root, key, from, to);
    if (auto* components = root.get_as<toml::table>("components")) {
        for (auto&& [name, component] : *components)
            if (auto* table = component.as_table()) move_path(*table, "profile", from, to);
    }
    if (auto* cruise = root.get_as<toml::table>("path"))
        for (const std::string_view key : {"waypoints", "flight_plan"}) move_path(*cruise, key, from, to);
    const auto schedule_below = schedule_text(compute, schedule);
    if (const auto kept = edit_keeping_comments(plain, read, root)) return {*kept + schedule_below, false};
    std::ostringstream out;
    out << toml::toml_formatter{root, toml::toml_formatter::default_flags & ~toml::format_flags::indentation};
    return {out.str() + "\n" + schedule_below, plain.find('#') != std::string::npos};
}

}  // namespace flightwatt::mission
