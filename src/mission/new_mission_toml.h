#pragma once

#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"

#include <string>
#include <vector>

namespace flightwatt::mission {

/// A component of a new mission.
struct NewComponent {
    std::string name;
    std::string profile;  ///< file of its profile
    compute::PowerProfile power;
};

/// The contents of a new mission. Files are named as in the mission.
struct NewMission {
    std::string name;
    std::string mechanical;             ///< file of the mechanical model
    mechanical::MechanicalModel model;  ///< content of that file
    std::string battery;                ///< file of the battery
    battery::Battery pack;              ///< content of that file
    std::vector<NewComponent> components = {};
    bool is_planned = false;  ///< the schedule is left to `flightwatt plan`
};

/// Returns a mission file with every key of docs/missions.md explained: optional keys are commented out ("#key" without
/// a blank), with values that fit the files. It can be simulated unchanged, unless it is to be planned.
std::string new_mission_toml(const NewMission& mission);

}  // namespace flightwatt::mission
