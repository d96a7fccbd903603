#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "path/path_entries.h"

#include <string>
#include <vector>

namespace flightwatt::mission {

/// Returns the rates of a model's flights with which changes of height above one place are flown.
path::ClimbRates flown_rates(const mechanical::MechanicalModel& model);

/// Notes the first change of height above one place that has its rate from the model.
void note_rate_on_spot(const path::FlightPath& path, const path::ClimbRates& rates, MissionSetup& mission);

/// Reads `ground_altitude_m` of a path, if it has it: its altitudes are then known to be above that. Throws InputError
/// for one whose plan states them above home.
void read_ground_altitude(const TomlTable& path, path::PathDefaults& defaults);

/// Notes that take-off and landing do not follow from altitudes of which a file does not state how high they are above
/// home, where the path begins higher than the model's flights climbed.
void note_unknown_height(const path::PathDefaults& defaults, MissionSetup& mission);

/// Takes altitudes of which it is not known how high they are above home as a written plan states them: as those above
/// home, or of a home at sea level; 50 m where none is stated. Notes it.
void take_heights_as_written(const std::vector<path::PathEntry>& entries, path::PathDefaults& defaults,
                             MissionSetup& mission);

/// How long take-off and landing last.
struct TakeoffAndLanding {
    PerPhase<double> duration_s;
    std::vector<std::string> notes = {};
    std::vector<std::string> uncertain = {};  ///< as MissionSetup::uncertain
};

/// Returns how long take-off and landing last by the altitudes at the ends of the mission's path, if these are known to
/// be above the ground and the mission does not state the duration; else the durations of the mission.
TakeoffAndLanding takeoff_and_landing(const MissionSetup& mission);

/// Sets these durations, and adds the notes to those of the mission.
void set_takeoff_and_landing(MissionSetup& mission);

}  // namespace flightwatt::mission
