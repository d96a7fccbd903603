#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

#include <optional>

/// The tables of a mission file that state what to plan (docs/missions.md). The readers throw InputError for keys that
/// are unknown, missing or out of range.
namespace flightwatt::mission {

/// The mission's [packs] without `home`, which read_cruise_path reads; none without one.
std::optional<Packs> read_packs(const TomlTable& mission);

/// The `utility` of a component.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

/// The mission's [plan], all of which may be absent.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

/// The mission's [policy]; none for a static one. `decide_every_s` stays 0 where it is not given.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

}  // namespace flightwatt::mission
