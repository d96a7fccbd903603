#pragma once

#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"

#include <string>
#include <vector>

namespace flightwatt::mission {

/// A component of a mission that is yet to be written.
struct NewComponent {
    std::string name;
    std::string profile;  ///< its file, as the mission is to name it
    compute::PowerProfile power;
};

/// Contents of a new mission. Files are named as the mission is to name them.
struct NewMission {
    std::string name;
    std::string mechanical;
    mechanical::MechanicalModel model;  ///< that file's
    std::string battery;
    battery::Battery pack;  ///< that file's
    std::vector<NewComponent> components = {};
    bool is_planned = false;  ///< the schedule is left to `flightwatt plan`
};

/// A mission file with every key of docs/missions.md explained: those that it can do without are commented out ("#key"
/// without a blank), with values that fit the files. It simulates as it is, unless it is to be planned.
std::string new_mission_toml(const NewMission& mission);

}  // namespace flightwatt::mission
