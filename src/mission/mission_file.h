#pragma once

#include "mission/mission.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mission {

/// What else than the file decides how a mission is read.
struct MissionReadOptions {
    bool allow_unplanned = false;         ///< accept a mission that is yet to be planned
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
MissionVariant read_mission(const std::filesystem::path& path, const MissionReadOptions& reading = {});

/// The same from text; `path` names it and is where relative paths start.
MissionVariant parse_mission(std::string_view text, const std::filesystem::path& path,
                             const MissionReadOptions& reading = {});

/// A mission file with another schedule.
struct PlannedMissionText {
    std::string text;
    bool lost_comments = false;  ///< the keys are sorted and stand without what was said of them
};

/// The mission file `text` (of `path`) with `schedule` in the place of its [plan], [policy] and [[schedule]];
/// everything else stands as it was written, with its comments, if the text allows that: lines end as Unix ends them.
/// `compute` is the mission's. The files that it names are found from `folder`, where the result is to stand.
PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder);

/// A component of a mission that is yet to be written.
struct NewComponent {
    std::string name;
    std::string profile;  ///< its file, as the mission is to name it
    compute::PowerProfile power;
};

/// What a new mission is made of. Files are named as the mission is to name them.
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
