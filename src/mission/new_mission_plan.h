#pragma once

#include "mission/new_mission_toml.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// A plan that a new mission flies.
struct PlanToFly {
    std::filesystem::path file;
    std::string name;                             ///< the file as the mission names it
    std::vector<std::string> blocks = {};         ///< of a flight plan of Paparazzi
    std::optional<double> airspeed_m_per_s = {};  ///< as stated beside the plan
};

/// Sets the path of a mission and its airspeed: as stated, as the plan states it, or as the model's flights. What
/// QGroundControl writes by default counts where the flights flew it: else it is a speed that was never set. Throws as
/// path_of_plan(), and InputError for the file of a model that predicts no power along a plan.
void fly_plan(const PlanToFly& plan, const std::string& model_file, NewMission& fresh);

}  // namespace flightwatt::mission
