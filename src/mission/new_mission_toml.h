#pragma once

#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"
#include "mission/new_mission_path.h"
#include "path/path.h"

#include <cstddef>
#include <optional>
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
    bool is_planned = false;              ///< the schedule is left to `flightwatt plan`
    std::optional<double> cruise_s = {};  ///< none: the mean of the model's flights
    std::optional<double> payload_kg = {};
    std::optional<double> takeoff_mass_kg = {};
    std::optional<NewPath> flown = {};            ///< then it decides the duration of the cruise
    std::optional<double> airspeed_m_per_s = {};  ///< none: new_airspeed_m_per_s()
    std::optional<path::Wind> wind = {};          ///< along the path
    double reserve_soc_percent = 20.0;
    std::optional<std::size_t> packs = {};  ///< states [packs]
    bool states_parameters = false;         ///< names of the profiles' parameters are stated, as the files lack them
    bool shows_all_keys = false;
};

/// Airspeed for the cruise of a new mission: that of the model's flights, or one of a small wing.
double new_airspeed_m_per_s(const mechanical::MechanicalModel& model);

/// Returns a mission file with what is stated here; with `shows_all_keys` every key of docs/missions.md explained:
/// optional keys are commented out ("#key" without a blank), with values that fit the files. It can be simulated
/// unchanged, unless it is to be planned.
std::string new_mission_toml(const NewMission& mission);

}  // namespace flightwatt::mission
