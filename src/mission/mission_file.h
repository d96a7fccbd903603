#pragma once

#include "mission/mission.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::mission {

/// What else than the file decides how a mission is read.
struct MissionReading {
    bool may_lack_schedule = false;  ///< accept a mission that is yet to be planned
    std::optional<double> cruise_s;  ///< fly the cruise this long, whatever the file says
};

/// Reads a mission file (docs/missions.md):
///
///     format = 1                              # may be absent
///     name = "phased"                         # default: the file's name
///     mechanical = "../opterra.toml"          # or "none": then every phase needs its duration
///     duration_s = { cruise = 600 }           # default: the model's; 0 does not fly the phase
///     phase_clock = "stretch"                 # or "absolute": a phase's curve runs on in its own seconds
///     conditions = { airspeed_m_per_s = 14 }  # what the model's cruise level follows (its level_law)
///     battery = "../pack.toml"                # or { voltage_v = 11.1, resistance_ohm = 0.05, ... }
///     initial_soc_percent = 100
///     capacity_ah = 3.0                       # default: the battery's
///     cutoff_voltage_v = 9.9                  # default: none
///     reserve_soc_percent = 20                # default: 0
///     [components.detection]
///     profile = "../detection.csv"            # any format of compute/profile_reader.h
///     parameters = ["fps"]                    # names for a profile that has none; or `columns`
///     utility = { parameter = "fps" }         # of its quality: file/utility_toml.h
///     [plan]                                  # file/plan_settings_toml.h
///     [policy]                                # file/adaptive_policy_toml.h
///     [uncertainty]                           # file/uncertainty_toml.h
///     [[schedule]]                            # file/schedule_toml.h
///
/// A mission with [plan], with an adaptive policy, or with components and no [[schedule]], is a planning
/// problem: its [[schedule]] is what is fixed. Unless its policy plans in flight, it is refused where
/// `reading` does not accept it. Paths are relative to the mission file. Throws InputError, placed in the file
/// that is wrong, for a missing file, a key missing, unknown or out of range, and whatever schedules and
/// models refuse.
AnyMission read_mission(const std::filesystem::path& path, const MissionReading& reading = {});

/// The same from text; `path` names it and is where relative paths start.
AnyMission parse_mission(std::string_view text, const std::filesystem::path& path,
                         const MissionReading& reading = {});

/// The mission file `text` (of `path`) with `schedule` in the place of its [plan], [policy] and [[schedule]];
/// everything else says what it said, its keys sorted and without comments. `compute` is the mission's. The
/// files that it names are found from `folder`, where the result is to stand.
std::string planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                 const compute::ComputeModel& compute,
                                 const std::vector<ScheduleSegment>& schedule,
                                 const std::filesystem::path& folder);

}  // namespace flightwatt::mission
