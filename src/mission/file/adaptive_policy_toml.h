#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

#include <optional>

namespace flightwatt::mission {

/// Reads the [policy] of a mission:
///
///     kind = "adaptive"               # or "static", as without [policy]: flown as scheduled or planned
///     decide_every_s = 10             # default: the plan's slot
///     mechanical_sd_percent = 5       # these three: see AdaptivePolicy
///     learning_time_s = 60
///     probability = 0.95
///
/// None for a static one; decide_every_s stays 0 where it is not given. Throws InputError for unknown kinds
/// and keys, and numbers out of range.
std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission);

}  // namespace flightwatt::mission
