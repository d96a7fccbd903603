#include "report/document/mission_sliders.h"

#include "base/input_file.h"
#include "base/toml_reader.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

namespace fs = std::filesystem;

/// Adds a slider of a key of all tables, "TABLE.KEY" in the page; none for a range that is a point.
void add_slider(Json& sliders, const std::vector<TomlTable>& tables, const std::string& table, const char* key,
                double value, Interval range) {
    range = {std::min(range.low, value), std::max(range.high, value)};
    if (!(range.high > range.low)) return;
    auto places = Json::array();
    for (const auto& one : tables)
        if (one.has(key)) places.push_back({{"line", one.where(key).line}, {"column", one.where(key).column}});
    sliders.push_back({{"key", table.empty() ? key : fmt::format("{}.{}", table, key)},
                       {"value", value},
                       {"low", range.low},
                       {"high", range.high},
                       {"places", std::move(places)}});
}

/// Payload, wind and airspeed, where the mission or its model knows them.
void add_motion(Json& sliders, const TomlTable& root, const mission::MissionSetup& setup) {
    const auto physical = setup.mechanical ? setup.mechanical->physical : std::nullopt;
    const bool has_rotors = physical && physical->load.rotors;
    if (root.has("payload_kg") || has_rotors || (physical && physical->payload_kg)) {
        const double value_kg = root.optional_number("payload_kg").value_or(physical ? physical->load.payload_kg : 0.0);
        const double part_kg = has_rotors ? physical->load.rotors->mass_kg / 2.0 : 0.0;
        add_slider(sliders, {root}, "", "payload_kg", value_kg, {0.0, std::max(2.0 * value_kg, part_kg)});
    }
    const auto path = root.optional_table("path");
    const auto wind = root.optional_table("wind");
    if (path && physical && (!wind || (wind->has("speed_m_per_s") && wind->has("from_deg")))) {
        const auto tables = wind ? std::vector{*wind} : std::vector<TomlTable>();
        const auto value = [&](const char* key) { return wind ? wind->number(key) : 0.0; };
        add_slider(sliders, tables, "wind", "speed_m_per_s", value("speed_m_per_s"), {0.0, 15.0});
        add_slider(sliders, tables, "wind", "from_deg", value("from_deg"), {0.0, 360.0});
    }
    if (path ? !path->has("airspeed_m_per_s") : !physical) return;
    const auto& table = path ? *path : root;
    const double flown_m_per_s = physical ? physical->mean_airspeed_m_per_s : 0.0;
    const double value = table.optional_number("airspeed_m_per_s").value_or(flown_m_per_s);
    add_slider(sliders, {table}, path ? "path" : "", "airspeed_m_per_s", value, {value / 2.0, 2.0 * value});
}

/// A slider for each value that the schedule states of a parameter, if they are few.
void add_rates(Json& sliders, const TomlTable& root, const compute::ComputeModel& compute) {
    constexpr std::size_t max_values = 3;
    for (const auto& [name, profile] : compute.components) {
        for (std::size_t i = 0; i < profile.parameters.size(); ++i) {
            const auto& parameter = profile.parameters[i];
            std::map<double, std::vector<TomlTable>> tables_of;
            for (const auto& entry : root.tables("schedule"))
                if (const auto running = entry.table("run").optional_table(name))
                    tables_of[running->number(parameter)].push_back(*running);
            if (tables_of.size() > max_values) continue;
            const Interval range{profile.axes[i].front(), profile.axes[i].back()};
            for (const auto& [value, tables] : tables_of)
                add_slider(sliders, tables, name, parameter.c_str(), value, range);
        }
    }
}

std::vector<fs::path> named_files(const TomlTable& root) {
    std::vector<fs::path> names;
    const auto add = [&](const TomlTable& table, const char* key) {
        if (table.has(key) && !table.is_table(key)) names.emplace_back(table.string(key));
    };
    if (root.string("mechanical") != "none") add(root, "mechanical");
    add(root, "battery");
    if (const auto components = root.optional_table("components"))
        for (const auto& name : components->keys()) add(components->table(name), "profile");
    if (const auto path = root.optional_table("path"))
        for (const auto* key : {"waypoints", "flight_plan", "area"}) add(*path, key);
    return names;
}

}  // namespace

void add_sliders(std::span<const SimulatedMission> missions, Json& document) {
    std::set<fs::path> files;     // which missions name by relative paths
    std::set<fs::path> absolute;  // these stay where the missions have them
    for (std::size_t i = 0; i < missions.size(); ++i) {
        const auto& [mission, simulation, title, planned, is_longest] = missions[i];
        const auto& setup = mission.setup;
        const auto root = read_toml(setup.file, FileKind::mission);
        if (root.has("packs")) continue;
        const auto place = fs::absolute(setup.file).lexically_normal();
        files.insert(place);
        for (const auto& name : named_files(root))
            (name.is_relative() ? files : absolute).insert((place.parent_path() / name).lexically_normal());
        auto sliders = Json::array();
        const double capacity_ah = setup.battery.capacity_ah;
        add_slider(sliders, {root}, "", "reserve_soc_percent", setup.reserve_soc_percent, {0.0, 50.0});
        add_motion(sliders, root, setup);
        add_slider(sliders, {root}, "", "capacity_ah", capacity_ah, {capacity_ah / 2.0, 2.0 * capacity_ah});
        add_rates(sliders, root, setup.compute);
        document["missions"][i]["again"] = {
            {"file", place.string()}, {"is_planned", planned.has_value()}, {"sliders", std::move(sliders)}};
    }
    auto folder = files.empty() ? fs::path() : files.begin()->parent_path();
    for (const auto& file : files)
        while (*file.lexically_relative(folder).begin() == "..") folder = folder.parent_path();
    for (auto& mission : document["missions"])
        if (auto& again = mission["again"]; !again.is_null())
            again["file"] = fs::path(again["file"].get<std::string>()).lexically_relative(folder).string();
    for (const auto& file : files)
        document["files"].push_back({{"path", file.lexically_relative(folder).string()}, {"text", read_file(file)}});
    for (const auto& file : absolute) document["files"].push_back({{"path", file.string()}, {"text", read_file(file)}});
}

}  // namespace flightwatt::report
