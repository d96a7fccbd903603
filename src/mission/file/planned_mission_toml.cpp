#include "base/toml_reader.h"
#include "base/toml_text.h"
#include "mission/file/text_editing.h"
#include "mission/file/toml_keys.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace flightwatt::mission {
namespace {

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

std::string toml_key(const std::string& name) {
    const bool bare = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
        return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
    });
    return bare ? name : toml_string(name);
}

std::string toml_inline_table(const std::vector<std::string>& pairs) {
    return pairs.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(pairs, ", "));
}

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
