#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Changes the mechanical model for the mission's payload_kg, if that is stated: its phases in proportion to the power
/// by the physical model, or, if the flights do not determine that, by the takeoff_mass_kg and an assumption, with a
/// note and a wider spread. Throws InputError if neither is known.
void apply_payload(const TomlTable& mission_table, MissionSetup& mission);

}  // namespace flightwatt::mission
