#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

#include <optional>

/// The tables of a mission file (docs/missions.md) that say what a plan is made of. All throw InputError for what is
/// unknown, missing or out of range.
namespace flightwatt::mission {

/// The `utility` of a component.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

/// The mission's [plan], all of which may be absent.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

/// The mission's [policy]; none for a static one. `decide_every_s` stays 0 where it is not given.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

}  // namespace flightwatt::mission
