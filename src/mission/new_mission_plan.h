#pragma once

#include "mission/new_mission_toml.h"

#include <string>

namespace flightwatt::mission {

/// Sets the path of a mission and its airspeed: as stated, as the plan states it, or as the model's flights. What
/// QGroundControl writes by default counts where the flights flew it: else it is a speed that was never set. Throws as
/// path_of_plan(), and InputError for the file of a model that predicts no power along a plan.
void fly_plan(const PlanToFly& plan, const std::string& model_file, NewMission& fresh);

}  // namespace flightwatt::mission
