#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

#include <optional>

/// The tables of a mission file that state what to plan (docs/missions.md). The readers throw InputError for keys that
/// are unknown, missing or out of range.
namespace flightwatt::mission {

/// Reads the mission's [packs] without `home`, which read_cruise_path() reads; std::nullopt without [packs].
std::optional<Packs> read_packs(const TomlTable& mission);

/// Reads the `utility` of a component.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

/// Reads the mission's [plan], all keys of which are optional.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

/// Reads the mission's [policy]; std::nullopt for a static one. `decide_every_s` is 0 if it is not given.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

}  // namespace flightwatt::mission
