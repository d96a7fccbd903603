#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"

#include <string>

namespace flightwatt::mission {

/// Returns which airspeeds the model's flights flew, and what to do about another one.
std::string near_flown_hint(const mechanical::PhysicalModel& physical);

/// Sets the mean power of the cruise to that of the mission's airspeed_m_per_s by the physical model, if it is stated.
/// Throws InputError for a model without a physical part, and for an airspeed far beyond the range of its flights.
void apply_airspeed(const TomlTable& mission_table, MissionSetup& mission);

}  // namespace flightwatt::mission
