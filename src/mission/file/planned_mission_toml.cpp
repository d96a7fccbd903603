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

#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace flightwatt::mission {
namespace {

char first_character(const std::string& line) {
    const auto at = line.find_first_not_of(" \t\r");
    return at == std::string::npos ? '\0' : line[at];
}

bool is_blank(const std::string& line) { return first_character(line) == '\0'; }
bool is_comment(const std::string& line) { return first_character(line) == '#'; }
bool is_header(const std::string& line) { return first_character(line) == '['; }

/// Erases the section at `header`, without comments at its end that are separated from its keys.
void erase_section(std::vector<std::string>& lines, std::size_t header) {
    auto end = header + 1;
    while (end < lines.size() && !is_header(lines[end])) ++end;
    auto last = end;
    while (last > header + 1 && (is_blank(lines[last - 1]) || is_comment(lines[last - 1]))) --last;
    while (last < end && is_comment(lines[last])) ++last;  // directly below its last key
    if (last == end && end < lines.size()) {               // or directly above the next header, to which they belong
        while (last > header + 1 && is_comment(lines[last - 1])) --last;
    }
    auto first = header;
    while (first > 0 && is_comment(lines[first - 1])) --first;
    if (first > 0 && last < lines.size() && is_blank(lines[first - 1]) && is_blank(lines[last])) ++last;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.begin() + static_cast<std::ptrdiff_t>(last));
}

void erase_schedule(std::vector<std::string>& lines) {
    static const std::regex of_header(R"(^\s*\[\[?\s*(plan|policy|schedule)\s*(\.|\]).*)");
    static const std::regex of_key(R"(^\s*(plan|policy|schedule)\s*(\.|=).*)");
    const auto is_section = [&](const std::string& line) { return std::regex_match(line, of_header); };
    for (auto at = std::ranges::find_if(lines, is_section); at != lines.end();
         at = std::ranges::find_if(lines, is_section))
        erase_section(lines, static_cast<std::size_t>(at - lines.begin()));
    const auto root_end = std::ranges::find_if(lines, is_header);
    lines.erase(
        std::remove_if(lines.begin(), root_end, [&](const auto& line) { return std::regex_match(line, of_key); }),
        root_end);
}

/// Replaces the string `read` in its line by `wanted`, if it is quoted on one line.
void rename_file(std::vector<std::string>& lines, const toml::value<std::string>& read, const std::string& wanted) {
    const auto place = read.source().begin;
    if (place.line < 1 || place.line > lines.size()) return;
    auto& line = lines[place.line - 1];
    const std::size_t start = place.column - 1;
    if (start >= line.size() || (line[start] != '"' && line[start] != '\'')) return;
    const auto end = line.find(line[start], start + 1);
    if (end == std::string::npos) return;
    line.replace(start, end + 1 - start, toml_string(wanted));
}

/// Follows both tables and renames what differs in a text.
void rename_files(std::vector<std::string>& lines, const toml::table& read, const toml::table& wanted) {
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

/// Without a byte order mark, and with the line ends of Unix.
std::string normalise_text(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    return boost::algorithm::replace_all_copy(std::string(text), "\r\n", "\n");
}

/// Edits `text`, whose content is `read`, to the content `wanted`, and keeps comments, order and spelling of the rest:
/// removes plan, policy and schedule with the comments directly above and in them, renames files, adds the format.
/// The result is parsed again; std::nullopt if its content is not `wanted`.
std::optional<std::string> edit_keeping_comments(std::string_view text, const toml::table& read,
                                                 const toml::table& wanted) {
    std::vector<std::string> lines;
    boost::algorithm::split(lines, text, [](char c) { return c == '\n'; });
    rename_files(lines, read, wanted);
    erase_schedule(lines);
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
    auto kept = fmt::format("{}\n", fmt::join(lines, "\n"));
    if (!read.contains("format") && wanted.contains("format")) {
        const auto version = wanted["format"].value_or<std::int64_t>(0);
        std::size_t at = 0;  // below the comments that the file begins with
        while (at < kept.size() && kept[at] == '#') at = kept.find('\n', at) + 1;
        kept.insert(at, fmt::format("format = {}\n", version));
    }
    try {
        if (toml::parse(kept) == wanted) return kept;
    } catch (const toml::parse_error&) {
        // a section in an unexpected notation
    }
    return std::nullopt;
}

/// Unchanged if the working folder does not exist any more.
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
    *value = (error ? from / named : near).generic_string();
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
