#pragma once

#include "mission/mission.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::mission {

/// What else than the file decides how a mission is read.
struct MissionReading {
    bool may_lack_schedule = false;       ///< accept a mission that is yet to be planned
    std::optional<double> cruise_s = {};  ///< fly the cruise this long, whatever the file says
    // Of a path: fly the last circles of it so often; or turn back after so many metres of legs.
    std::optional<double> circles = {};
    std::optional<double> return_after_m = {};
};

/// Reads a mission file (docs/missions.md). A mission with [plan], with an adaptive policy, or with components and no
/// [[schedule]], is a planning problem: its [[schedule]] is what is fixed. Unless its policy plans in flight, it is
/// refused where `reading` does not accept it. Paths are relative to the mission file. Throws InputError, placed in
/// the file that is wrong, for a missing file, a key missing, unknown or out of range, and whatever schedules and
/// models refuse.
AnyMission read_mission(const std::filesystem::path& path, const MissionReading& reading = {});

/// The same from text; `path` names it and is where relative paths start.
AnyMission parse_mission(std::string_view text, const std::filesystem::path& path, const MissionReading& reading = {});

/// The mission file `text` (of `path`) with `schedule` in the place of its [plan], [policy] and [[schedule]];
/// everything else says what it said, its keys sorted and without comments. `compute` is the mission's. The
/// files that it names are found from `folder`, where the result is to stand.
std::string planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                 const compute::ComputeModel& compute, const Schedule& schedule,
                                 const std::filesystem::path& folder);

}  // namespace flightwatt::mission
