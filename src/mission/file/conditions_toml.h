#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Sets the level of the cruise to what the mission states of it, [conditions] or airspeed_m_per_s, by the model's
/// laws; leaves it where nothing is stated. Throws InputError for what no law of the model follows, or beyond its
/// flights.
void apply_conditions(const TomlTable& mission_table, MissionSetup& mission);

}  // namespace flightwatt::mission
