#include "base/atomic_file.h"
#include "compute/profile_reader.h"
#include "mission/file/adaptive_policy_toml.h"
#include "mission/file/conditions_toml.h"
#include "mission/file/plan_settings_toml.h"
#include "mission/file/schedule_toml.h"
#include "mission/file/uncertainty_toml.h"
#include "mission/file/utility_toml.h"
#include "mission/mission.h"

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double shortest_phase_s = 1e-3;
constexpr double longest_phase_s = 1e7;  // a third of a year: beyond, it is a mistake in the unit

/// The file that a key names, relative to the mission file.
std::filesystem::path file_of(const TomlTable& table, std::string_view key) {
    auto path = std::filesystem::path(table.file()).parent_path() / table.string(key);
    if (!std::filesystem::exists(path)) {
        throw InputError(table.where(key), fmt::format("{}: there is no file {}", key, path.string()),
                         "paths are relative to the mission file");
    }
    return path;
}

std::optional<mechanical::MechanicalModel> read_mechanical(const TomlTable& root) {
    if (root.string("mechanical") == "none") return std::nullopt;
    return mechanical::read_mechanical_model(file_of(root, "mechanical"));
}

mechanical::PhaseClock read_clock(const TomlTable& root, bool has_mechanical) {
    const auto name = root.optional_string("phase_clock");
    if (!name) return mechanical::PhaseClock::stretched;
    if (!has_mechanical) {
        throw InputError(root.where("phase_clock"), "phase_clock has no meaning with mechanical = \"none\"",
                         "leave it out");
    }
    if (*name == "stretch") return mechanical::PhaseClock::stretched;
    if (*name == "absolute") return mechanical::PhaseClock::absolute;
    throw InputError(root.where("phase_clock"), fmt::format("there is no phase_clock '{}'", *name),
                     "it is \"stretch\" or \"absolute\"");
}

double read_duration(const TomlTable& durations, std::string_view phase) {
    const double value = durations.number(phase);
    if (value != 0.0 && (value < shortest_phase_s || value > longest_phase_s)) {
        throw InputError(
            durations.where(phase), fmt::format("{} = {} s is no phase's duration", phase, value),
            fmt::format("expected 0 (not flown) or {} .. {} s", shortest_phase_s, longest_phase_s));
    }
    return value;
}

flight::PerPhase<double> read_durations(const TomlTable& root,
                                        const std::optional<mechanical::MechanicalModel>& mechanical) {
    flight::PerPhase<double> durations;
    if (mechanical) {
        for (const auto phase : flight::all_phases) durations[phase] = mechanical->phases[phase].duration_s;
    } else if (!root.has("duration_s")) {
        throw InputError(root.where("mechanical"), "without a mechanical model the phases have no durations",
                         "add duration_s = { takeoff = ..., cruise = ..., landing = ... }");
    }
    double total_s = 0.0;
    const auto given = root.optional_table("duration_s");
    for (const auto phase : flight::all_phases) {
        const auto name = to_string(phase);
        if (given && (!mechanical || given->has(name))) durations[phase] = read_duration(*given, name);
        total_s += durations[phase];
    }
    if (given) given->refuse_unknown_keys();
    if (total_s == 0.0) throw InputError(root.where("duration_s"), "all phases take 0 s, expected a mission");
    return durations;
}

/// An optional number that is to be above `low` (or at it, if that makes sense) and at most `high`.
std::optional<double> optional_between(const TomlTable& root, std::string_view key, double low, double high,
                                       bool low_too) {
    const auto value = root.optional_number(key);
    if (value && (*value > high || *value < low || (*value == low && !low_too))) {
        throw InputError(root.where(key), fmt::format("{} = {} is out of range", key, *value),
                         fmt::format("expected {} {} to {}", low_too ? "from" : "above", low, high));
    }
    return value;
}

battery::Battery read_mission_battery(const TomlTable& root) {
    auto battery = root.is_table("battery") ? battery::battery_from(root.table("battery"))
                                            : battery::read_battery(file_of(root, "battery"));
    if (const auto capacity_ah = optional_between(root, "capacity_ah", 0.0, 1e6, false)) {
        battery.capacity_ah = *capacity_ah;
        battery.intervals.capacity_ah.reset();  // that was of the other capacity
    }
    return battery;
}

compute::Component read_component(const TomlTable& table, const std::string& name) {
    table.refuse_keys_except({"profile", "parameters", "columns", "utility"});
    compute::ProfileNaming naming;
    naming.where = table.where();
    for (const std::string_view key : {"parameters", "columns"}) {
        if (!table.has(key)) continue;
        (key == "columns" ? naming.columns : naming.parameters) = table.strings(key);
        naming.where = table.where(key);
        if (naming.parameters.empty() && naming.columns.empty()) {
            throw InputError(naming.where, fmt::format("{} = [] names nothing", key), "leave it out");
        }
    }
    return {name, read_power_profile(file_of(table, "profile"), naming)};
}

void read_components(const TomlTable& root, Mission& mission) {
    const auto components = root.optional_table("components");
    if (!components) return;
    for (const auto& name : components->keys()) {
        const auto table = components->table(name);
        mission.compute.components.push_back(read_component(table, name));
        std::optional<Utility> utility;
        if (const auto stated = table.optional_table("utility")) {
            utility = read_utility(*stated, mission.compute.components.back().profile);
        }
        mission.utilities.push_back(std::move(utility));
    }
}

/// The stretches that are fixed, the rest to be planned; or, as it should be, the whole schedule.
void read_mission_schedule(const TomlTable& root, const MissionReading& reading, Mission& mission) {
    auto entries = read_schedule(root, mission.compute, mission.duration_s);
    const bool lacks_schedule = entries.empty() && !mission.compute.components.empty();
    const bool may_lack_schedule = reading.may_lack_schedule || mission.adaptive;
    if (lacks_schedule && !root.has("plan") && !may_lack_schedule) {
        throw InputError(root.where("components"), "there are components and no [[schedule]] that runs them",
                         "add [[schedule]] with otherwise = true and run = { ... }, or let `flightwatt plan` "
                         "make a schedule");
    }
    if (root.has("plan") && !may_lack_schedule) {
        throw InputError(root.where("plan"), "this mission has no complete schedule: it is yet to be planned",
                         "`flightwatt plan` makes one; without [plan], [[schedule]] is taken as complete");
    }
    if (lacks_schedule || root.has("plan") || mission.adaptive) {
        mission.plan = read_plan_settings(root, mission.compute);
        mission.schedule = lay_out_fixed(entries, mission.duration_s);
        if (mission.adaptive && mission.adaptive->decide_every_s == 0.0)
            mission.adaptive->decide_every_s = mission.plan->slot_s;
        return;
    }
    if (entries.empty()) {
        ScheduleEntry nothing;  // mechanical only: nothing runs, all the time
        nothing.otherwise = true;
        nothing.where = root.where();
        entries.push_back(nothing);
    }
    mission.schedule = lay_out(entries, mission.duration_s);
}

double read_initial_soc(const TomlTable& root) {
    const double soc = root.optional_number("initial_soc_percent").value_or(100.0);
    if (soc <= 0.0 || soc > 100.0) {
        throw InputError(root.where("initial_soc_percent"),
                         fmt::format("initial_soc_percent = {} is out of range", soc),
                         "expected above 0, to 100");
    }
    return soc;
}

}  // namespace

Mission parse_mission(std::string_view text, const std::filesystem::path& path,
                      const MissionReading& reading) {
    const auto root = parse_toml(text, path.string());
    root.refuse_keys_except({"name", "mechanical", "duration_s", "phase_clock", "conditions", "battery",
                             "initial_soc_percent", "capacity_ah", "cutoff_voltage_v", "reserve_soc_percent",
                             "components", "schedule", "plan", "policy", "uncertainty"});
    Mission mission;
    mission.file = path.string();
    mission.name = root.optional_string("name").value_or(path.stem().string());
    mission.mechanical = read_mechanical(root);
    mission.phase_clock = read_clock(root, mission.mechanical.has_value());
    if (const auto conditions = root.optional_table("conditions")) {
        mission.cruise_level = mission::apply_conditions(*conditions, mission.mechanical);
    }
    mission.duration_s = read_durations(root, mission.mechanical);
    if (reading.cruise_s) mission.duration_s[flight::Phase::cruise] = *reading.cruise_s;
    mission.battery = read_mission_battery(root);
    read_components(root, mission);
    mission.initial_soc_percent = read_initial_soc(root);
    mission.cutoff_voltage_v = optional_between(root, "cutoff_voltage_v", 0.0, 1e6, true).value_or(0.0);
    mission.reserve_soc_percent =
        optional_between(root, "reserve_soc_percent", 0.0, 100.0, true).value_or(0.0);
    mission.adaptive = read_adaptive_policy(root);
    read_mission_schedule(root, reading, mission);
    mission.uncertainty = read_uncertainty(root, mission.compute, mission.mechanical.has_value());
    return mission;
}

Mission read_mission(const std::filesystem::path& path, const MissionReading& reading) {
    return parse_mission(read_file(path), path, reading);
}

}  // namespace flightwatt::mission
