#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "mission/mission_file.h"

namespace flightwatt::mission {

/// Reads [path] and [wind] of a mission file (docs/missions.md), where there is a path, and makes the cruise of it: its
/// path, duration and level. `reading` may change how much of it is flown. Throws InputError for a key missing, unknown
/// or out of range, a path that cannot be flown, and a model that does not know what motion takes.
void read_cruise_path(const TomlTable& mission_table, const MissionReadOptions& reading, MissionSetup& mission);

}  // namespace flightwatt::mission
