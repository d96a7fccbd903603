#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Changes the mechanical model to the mission's payload_kg, if it is stated: its phases in proportion to the physical
/// model's power, or, where the flights do not determine that, by their takeoff_mass_kg and an assumption, with a note
/// and a wider spread. Throws InputError where neither is known.
void apply_payload(const TomlTable& mission_table, MissionSetup& mission);

}  // namespace flightwatt::mission
