#include "mission/planned_mission_toml.h"

#include "base/text.h"
#include "base/toml_reader.h"

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <sstream>

#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace flightwatt::mission {
namespace {

using Lines = std::vector<std::string>;

char first_character(const std::string& line) {
    const auto at = line.find_first_not_of(" \t\r");
    return at == std::string::npos ? '\0' : line[at];
}

bool is_header(const std::string& line) { return first_character(line) == '['; }
bool is_comment(const std::string& line) { return first_character(line) == '#'; }
bool is_blank(const std::string& line) { return first_character(line) == '\0'; }

/// Erases the section that begins with a header, and the comments directly above it; those behind its keys stay.
Lines::iterator erase_section(Lines& lines, Lines::iterator header) {
    const auto next = std::find_if(header + 1, lines.end(), is_header);
    auto end = next;
    while (end > header + 1 && (is_blank(*(end - 1)) || is_comment(*(end - 1)))) --end;
    end = std::find_if_not(end, next, is_blank);
    while (header > lines.begin() && is_comment(*(header - 1))) --header;
    return lines.erase(header, end);
}

/// Removes plan, policy and schedule.
void erase_schedule(Lines& lines) {
    static const std::regex of_header(R"(^\s*\[\[?\s*(plan|policy|schedule)\s*(\.|\]).*)");
    static const std::regex of_key(R"(^\s*(plan|policy|schedule)\s*(\.|=).*)");
    for (auto at = lines.begin(); at != lines.end();)
        at = std::regex_match(*at, of_header) ? erase_section(lines, at) : at + 1;
    const auto root_end = std::ranges::find_if(lines, is_header);
    lines.erase(
        std::remove_if(lines.begin(), root_end, [&](const auto& line) { return std::regex_match(line, of_key); }),
        root_end);
}

/// Keys of [path] whose values were choices, with the chosen ones.
using ChosenValues = std::map<std::string, double>;

/// Replaces the choices of [path] by what was chosen; those that are not in `chosen` are removed.
void replace_choices(Lines& lines, const ChosenValues& chosen) {
    static const std::regex choice(R"(^(\s*(spacing_m|heading_deg|airspeed_m_per_s)\s*=\s*)\{[^}]*\}(.*)$)");
    std::smatch found;
    for (auto at = lines.begin(); at != lines.end();) {
        if (!std::regex_match(*at, found, choice)) {
            ++at;
        } else if (const auto value = chosen.find(found[2].str()); value != chosen.end()) {
            *at = found[1].str() + toml_real(value->second) + found[3].str();
            ++at;
        } else {
            at = lines.erase(at);
        }
    }
}

/// A file name that changes.
struct RenamedFile {
    std::string read;
    std::string wanted;
};

/// Without a byte order mark, and with the line ends of Unix.
std::string normalise_text(std::string_view text) {
    return boost::algorithm::replace_all_copy(std::string(without_byte_order_mark(text)), "\r\n", "\n");
}

/// Edits `text` to the content `wanted`, and keeps comments, order and spelling of the rest: removes plan, policy and
/// schedule, replaces choices, renames files, adds the format. The result is parsed again; std::nullopt if its content is not `wanted`.
std::optional<std::string> edit_keeping_comments(const std::string& text, const std::vector<RenamedFile>& renamed,
                                                 const std::optional<ChosenValues>& chosen, const toml::table& wanted) {
    Lines lines;
    boost::algorithm::split(lines, text, [](char c) { return c == '\n'; });
    erase_schedule(lines);
    if (chosen) replace_choices(lines, *chosen);
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
    auto kept = fmt::format("{}\n", fmt::join(lines, "\n"));
    for (const auto& [read, name] : renamed)
        for (const char quote : {'"', '\''})
            boost::algorithm::replace_all(kept, quote + read + quote, toml_string(name));
    try {
        if (!toml::parse(kept).contains("format")) {
            std::size_t at = 0;  // below the comments that the file begins with
            while (at < kept.size() && kept[at] == '#') at = kept.find('\n', at) + 1;
            kept.insert(at, format_line());
        }
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
               const std::filesystem::path& to, std::vector<RenamedFile>& renamed) {
    auto* value = table.get_as<std::string>(key);
    if (value == nullptr || (key == "mechanical" && value->get() == "none")) return;
    const std::filesystem::path named = value->get();
    if (named.is_absolute()) return;
    std::error_code error;
    const auto near = std::filesystem::proximate(from / named, to, error);
    renamed.push_back({value->get(), (error ? from / named : near).generic_string()});
    *value = renamed.back().wanted;
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

/// The entries of a schedule; with `open_ends` the last of a phase is until its end, whenever that is.
std::string schedule_text(const compute::ComputeModel& compute, const Schedule& schedule, bool open_ends) {
    std::string text;
    for (std::size_t i = 0; i < schedule.size(); ++i) {
        const auto& segment = schedule[i];
        const bool is_last = i + 1 == schedule.size() || schedule[i + 1].phase != segment.phase;
        const auto to = open_ends && is_last ? "" : fmt::format("to = {}\n", toml_real(segment.end_s));
        text +=
            fmt::format("\n[[schedule]]\nphase = {}\nfrom = {}\n{}run = {}\n", toml_string(to_string(segment.phase)),
                        toml_real(segment.start_s), to, run_text(compute, segment.run));
    }
    return text;
}

/// Makes a mission with [packs] that of one flight: its pack, and its plan instead of the path. Of the path's keys those
/// remain by which a plan is flown.
void choose_pack(toml::table& root, const PlannedPack& pack) {
    root.insert_or_assign("name", pack.name);
    if (const auto* battery = root["packs"]["battery"][pack.pack - 1].as_string())
        root.insert_or_assign("battery", battery->get());
    root.erase("packs");
    const auto& path = *root.get_as<toml::table>("path");
    toml::table flown;
    for (const auto* key : {"airspeed_m_per_s", "climb_m_per_s", "descent_m_per_s", "max_bank_deg", "turn_radius_m"})
        if (const auto* value = path.get(key)) flown.insert(key, *value);
    const bool changes_speed = pack.blocks.empty();  // by commands of its plan, for which a stated one may remain
    if (pack.airspeed_m_per_s && !(changes_speed && flown.contains("airspeed_m_per_s")))
        flown.insert_or_assign("airspeed_m_per_s", *pack.airspeed_m_per_s);
    flown.insert(pack.blocks.empty() ? "waypoints" : "flight_plan", pack.plan_file);
    toml::array blocks;
    for (const auto& block : pack.blocks) blocks.push_back(block);
    if (!blocks.empty()) flown.insert("blocks", std::move(blocks));
    root.insert_or_assign("path", std::move(flown));
}

/// Puts the chosen lines into a [path]: returns what was chosen; std::nullopt if all is fixed. Lines of several spacings are strips instead.
std::optional<ChosenValues> choose_lines(toml::table& path, const path::SurveyLayout& layout) {
    constexpr std::array keys{"spacing_m", "heading_deg", "airspeed_m_per_s"};
    const auto is_choice = [&](const char* key) { return path.get_as<toml::table>(key) != nullptr; };
    if (std::ranges::none_of(keys, is_choice)) return std::nullopt;
    const auto& first = layout.strips.front();
    ChosenValues chosen;
    if (is_choice("heading_deg")) chosen["heading_deg"] = layout.heading_deg;
    if (is_choice("airspeed_m_per_s")) chosen["airspeed_m_per_s"] = *first.airspeed_m_per_s;
    if (layout.strips.size() > 1)
        path.erase("spacing_m");
    else if (is_choice("spacing_m"))
        chosen["spacing_m"] = first.spacing_m;
    for (const auto& [key, value] : chosen) path.insert_or_assign(key, value);
    path.is_inline(false);  // strips are appended
    return chosen;
}

std::string strips_text(const path::SurveyLayout& layout) {
    std::string text;
    for (const auto& strip : layout.strips) {
        text +=
            fmt::format("\n[[path.strip]]\nto = {}\nspacing_m = {}\n", toml_real(strip.to), toml_real(strip.spacing_m));
        if (strip.airspeed_m_per_s) text += fmt::format("airspeed_m_per_s = {}\n", toml_real(*strip.airspeed_m_per_s));
    }
    return text;
}

}  // namespace

PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder,
                                        const std::optional<path::SurveyLayout>& survey,
                                        const std::optional<PlannedPack>& pack) {
    const auto plain = normalise_text(text);
    auto root = toml::parse(plain, path.string());
    root.insert_or_assign("format", format_version);
    root.erase("plan");
    root.erase("schedule");
    root.erase("policy");  // the schedule is decided
    const auto from = absolute_path(path).parent_path();
    const auto to = absolute_path(folder);
    if (pack) choose_pack(root, *pack);
    std::vector<RenamedFile> renamed;
    for (const std::string_view key : {"mechanical", "battery"}) move_path(root, key, from, to, renamed);
    if (auto* components = root.get_as<toml::table>("components")) {
        for (auto&& [name, component] : *components)
            if (auto* table = component.as_table()) move_path(*table, "profile", from, to, renamed);
    }
    std::optional<ChosenValues> chosen;
    if (auto* cruise = root.get_as<toml::table>("path"); cruise != nullptr && !pack) {
        for (const std::string_view key : {"waypoints", "flight_plan", "area", "terrain"})
            move_path(*cruise, key, from, to, renamed);
        if (survey) chosen = choose_lines(*cruise, *survey);
    }
    const bool has_strips = chosen && survey->strips.size() > 1;
    const auto schedule_below =
        (has_strips ? strips_text(*survey) : "") + schedule_text(compute, schedule, pack.has_value());
    if (const auto kept = edit_keeping_comments(plain, renamed, chosen, root)) return {*kept + schedule_below, false};
    std::ostringstream out;
    out << toml::toml_formatter{root, toml::toml_formatter::default_flags & ~toml::format_flags::indentation};
    return {out.str() + "\n" + schedule_below, plain.find('#') != std::string::npos};
}

}  // namespace flightwatt::mission
