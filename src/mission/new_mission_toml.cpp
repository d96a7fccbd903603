#include "mission/new_mission_toml.h"

#include "base/text.h"
#include "mission/mission.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {

/// config/new_mission.toml.in, of which CMake makes a string.
std::string_view new_mission_template();

namespace {

/// Replacement for each {{name}} of the template.
using Values = std::map<std::string, std::string, std::less<>>;

std::string fill_line(std::string_view line, const Values& values) {
    std::string filled;
    for (auto start = line.find("{{"); start != std::string_view::npos; start = line.find("{{")) {
        const auto end = line.find("}}");
        filled += line.substr(0, start);
        filled += values.find(line.substr(start + 2, end - start - 2))->second;
        line.remove_prefix(end + 2);
    }
    return filled.append(line);
}

/// The lines from {{#name}} to {{/}} are left out where the value is empty.
std::string fill(std::string_view text, const Values& values) {
    std::string filled;
    bool is_left_out = false;
    while (!text.empty()) {
        const auto line = text.substr(0, text.find('\n') + 1);
        text.remove_prefix(line.size());
        if (line.starts_with("{{#"))
            is_left_out = values.find(line.substr(3, line.find('}') - 3))->second.empty();
        else if (line.starts_with("{{/"))
            is_left_out = false;
        else if (!is_left_out)
            filled += fill_line(line, values);
    }
    return filled;
}

std::string if_so(bool condition, const char* text = "yes") { return condition ? text : ""; }

std::string list_of(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

/// Whether the cruise's power follows from its airspeed.
bool knows_airspeed(const mechanical::MechanicalModel& model) {
    return motion_predicts_best(model) && model.physical->mean_airspeed_m_per_s > 0.0;
}

void add_aircraft(const NewMission& mission, Values& values) {
    const auto& model = mission.model;
    const double cruise_s = mission.cruise_s.value_or(std::round(model.phases[Phase::cruise].duration_s));
    values["cruise"] = mission.flown ? "" : fmt::format("{}", cruise_s);
    // Stated where the physical model makes the cruise's power of it.
    values["physical"] = if_so(knows_airspeed(model) && !mission.flown);
    values["not_physical"] = if_so(!knows_airspeed(model));
    values["airspeed"] = mission.airspeed_m_per_s ? fmt::format("{}", *mission.airspeed_m_per_s)
                                                  : fmt::format("{:.1f}", new_airspeed_m_per_s(model));
    values["takeoff_mass"] = mission.takeoff_mass_kg ? fmt::format("{}", *mission.takeoff_mass_kg) : "";
    values["payload"] = mission.payload_kg ? fmt::format("{}", *mission.payload_kg) : "";
}

void add_path(const NewMission& mission, Values& values) {
    values["path"] = mission.flown ? fmt::format("{}", fmt::join(mission.flown->keys, "\n")) : "";
    values["wind"] = mission.wind ? fmt::format("{}", mission.wind->speed_m_per_s) : "";
    values["wind_from"] = mission.wind ? fmt::format("{}", mission.wind->from_deg) : "";
    values["reserve"] = fmt::format("{}", mission.reserve_soc_percent);
    values["packs"] = mission.packs ? fmt::format("{}", *mission.packs) : "";
}

/// The lines that are no comments, a blank line before each table.
std::string without_comments(const std::string& text) {
    std::string lines = "# `flightwatt new-mission --all-keys` explains the other keys (docs/missions.md).\n";
    std::istringstream all(text);
    for (std::string line; std::getline(all, line);) {
        if (line.empty() || line.starts_with('#')) continue;
        lines += (line.starts_with('[') ? "\n" : "") + line + "\n";
    }
    return lines;
}

/// As in the battery file; else estimated from the voltage of a full pack, or from the constant one, of LiPo cells.
int cells_of(const battery::Battery& pack) {
    constexpr double full_v = 4.2;
    constexpr double nominal_v = 3.7;
    if (pack.cells) return *pack.cells;
    const double cells =
        pack.thevenin ? pack.thevenin->open_circuit.voltage_v.back() / full_v : pack.voltage_v / nominal_v;
    return std::max(1, static_cast<int>(std::lround(cells)));
}

void add_battery(const battery::Battery& pack, Values& values) {
    constexpr double min_v_per_cell = 3.0;
    const int cells = cells_of(pack);
    values["capacity_ah"] = fmt::format("{:.3g}", pack.capacity_ah);
    values["cells_note"] = cells == 1 ? "" : fmt::format(", and this pack has about {}", cells);
    values["cutoff_voltage_v"] = fmt::format("{:.1f}", min_v_per_cell * cells);
}

/// "{ detection = { fps = 10 } }": of each parameter what `value` makes of the values that it was profiled at.
template <typename ValueOf>
std::vector<std::string> parameters_of(const std::vector<NewComponent>& components, const ValueOf& value) {
    std::vector<std::string> tables;
    for (const auto& [name, profile, power] : components) {
        std::vector<std::string> pairs;
        for (std::size_t i = 0; i < power.parameters.size(); ++i)
            pairs.push_back(fmt::format("{} = {}", toml_key(power.parameters[i]), value(power.axes[i])));
        tables.push_back(toml_key(name) + " = " + toml_inline_table(pairs));
    }
    return tables;
}

/// A key that may have a note behind it, on its line only if both fit.
void add_noted_key(const std::string& name, const std::string& key, std::string_view note, Values& values) {
    constexpr std::size_t max_line = 110;
    values[name] = key;
    values[name + "_note"] = key.size() + note.size() < max_line ? fmt::format("    {}", note) : "";
}

void add_schedule(const NewMission& mission, Values& values) {
    const auto& components = mission.components;
    values["components"] = if_so(!components.empty());
    values["no_components"] = if_so(components.empty());
    values["planned"] = if_so(!components.empty() && mission.is_planned);
    values["scheduled"] = if_so(!components.empty() && !mission.is_planned);
    if (components.empty()) return;
    values["first_component"] = toml_key(components.front().name);
    values["run"] =
        toml_inline_table(parameters_of(components, [](const auto& axis) { return axis[(axis.size() - 1) / 2]; }));
    auto levels = parameters_of(components, list_of);
    std::erase_if(levels, [](const auto& table) { return table.ends_with("= {}"); });
    add_noted_key("may_be_off", fmt::format("may_be_off = [{}]", toml_string(components.front().name)),
                  "# components that may be switched off", values);
    add_noted_key("levels", "levels = " + toml_inline_table(levels),
                  "# the values to choose from, instead of all that were profiled", values);
}

std::string component_text(std::string_view text, const NewComponent& component, bool states_parameters,
                           Values values) {
    const auto& power = component.power;
    std::vector<std::string> names;
    names.reserve(power.parameters.size() + 1);
    for (const auto& parameter : power.parameters) names.push_back(toml_string(parameter));
    values["component"] = toml_key(component.name);
    values["profile"] = toml_string(component.profile);
    values["parameters"] = fmt::format("{}", fmt::join(names, ", "));
    values["by_parameter"] = names.empty() ? "" : fmt::format("parameter = {}, ", names.front());
    values["shape"] = if_so(!names.empty(), ", shape = \"sqrt\"");
    values["instead"] = if_so(!values["planned"].empty(), "# (instead of the line above)\n");
    values["points_qos"] = names.empty() || power.axes.front().size() < 2
                               ? ""
                               : list_of({power.axes.front().front(), power.axes.front().back()});
    names.push_back("\"power_w\"");
    values["no_parameters"] = if_so(!states_parameters, "#");
    values["columns"] = fmt::format("{}", fmt::join(names, ", "));
    return fill(text, values);
}

}  // namespace

double new_airspeed_m_per_s(const mechanical::MechanicalModel& model) {
    constexpr double small_wing_m_per_s = 13.0;
    if (!model.physical || !(model.physical->mean_airspeed_m_per_s > 0.0)) return small_wing_m_per_s;
    return model.physical->cubic_mean_airspeed_m_per_s.value_or(model.physical->mean_airspeed_m_per_s);
}

std::string new_mission_toml(const NewMission& mission) {
    constexpr std::string_view each = "{{each component}}\n";
    constexpr std::string_view end_of_each = "{{end component}}\n";
    Values values{{"name", toml_string(mission.name)},
                  {"mechanical", toml_string(mission.mechanical)},
                  {"battery", toml_string(mission.battery)}};
    add_aircraft(mission, values);
    add_path(mission, values);
    add_battery(mission.pack, values);
    add_schedule(mission, values);
    const auto text = new_mission_template();
    const auto start = text.find(each);
    const auto end = text.find(end_of_each);
    auto filled = fill(text.substr(0, start), values);
    for (const auto& component : mission.components)
        filled += component_text(text.substr(start + each.size(), end - start - each.size()), component,
                                 mission.states_parameters, values);
    filled += fill(text.substr(end + end_of_each.size()), values);
    return mission.shows_all_keys ? filled : without_comments(filled);
}

}  // namespace flightwatt::mission
