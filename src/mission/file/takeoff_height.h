#pragma once

#include "mission/mission.h"

namespace flightwatt::mission {

/// Sets how long take-off and landing last by the altitudes at the ends of the mission's path, if these are known to be
/// above the ground and the mission does not state the duration. Notes it, and whether it makes the result uncertain.
void set_takeoff_and_landing(MissionSetup& mission);

}  // namespace flightwatt::mission
