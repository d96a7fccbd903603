#pragma once

#include "mission/mission.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mission {

/// Options of reading a mission.
struct MissionReadOptions {
    bool allow_unplanned = false;         ///< accept a mission that is yet to be planned
    std::optional<double> cruise_s = {};  ///< duration of the cruise, instead of the file's
    // Of a path: turns of its last circles; or distance along the legs from which it returns.
    std::optional<double> circles = {};
    std::optional<double> return_after_m = {};
};

/// Reads a mission file (docs/missions.md). A mission with [plan], an adaptive policy, or components and no
/// [[schedule]] is a planning problem, and its [[schedule]] is the fixed part; without an adaptive policy it is refused
/// unless allow_unplanned. Paths are relative to the file. Throws InputError with the location of the error.
MissionVariant read_mission(const std::filesystem::path& path, const MissionReadOptions& reading = {});

/// The same from text; `path` names it and is where relative paths start.
MissionVariant parse_mission(std::string_view text, const std::filesystem::path& path,
                             const MissionReadOptions& reading = {});

/// A mission file with another schedule.
struct PlannedMissionText {
    std::string text;
    bool lost_comments = false;  ///< the keys are sorted and have no comments
};

/// The mission file `text` (of `path`) with `schedule` instead of its [plan], [policy] and [[schedule]]; the rest is
/// kept as written, with comments, where the notation permits. Lines end with \n. `compute` is the mission's. Names of
/// files are relative to `folder`, where the result is written.
PlannedMissionText planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                        const compute::ComputeModel& compute, const Schedule& schedule,
                                        const std::filesystem::path& folder);

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
