#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "mission/mission_file.h"

#include <filesystem>
#include <optional>
#include <string_view>

/// The tables of a mission file (docs/missions.md). All throw InputError for keys that are unknown, missing or out of
/// range.
namespace flightwatt::mission {

/// The file that a key names, relative to the mission file. Throws InputError at the key where it cannot be read.
std::filesystem::path file_of(const TomlTable& table, std::string_view key);

/// Sets the level of the cruise to that of the mission's airspeed_m_per_s by the physical model; leaves it where none
/// is stated. Throws InputError for a model without one, and far beyond what its flights flew.
void apply_airspeed(const TomlTable& mission_table, MissionSetup& mission);

/// Reads [path] and [wind] of a mission file (docs/missions.md), where there is a path, and makes the cruise of it: its
/// path, duration and level. `reading` may change how much of it is flown. Throws InputError for a key missing, unknown
/// or out of range, a path that cannot be flown, and a model without a physical part.
void read_cruise_path(const TomlTable& mission_table, const MissionReadOptions& reading, MissionSetup& mission);

/// The `utility` of a component.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

/// The mission's [plan], all of which may be absent.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

/// The mission's [policy]; none for a static one. `decide_every_s` stays 0 where it is not given.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

}  // namespace flightwatt::mission
