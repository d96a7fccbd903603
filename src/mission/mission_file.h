#pragma once

#include "mission/mission.h"
#include "mission/mission_read_options.h"

#include <filesystem>
#include <string_view>

namespace flightwatt::mission {

/// Reads a mission file (docs/missions.md). A mission with [plan], an adaptive policy, or components and no
/// [[schedule]] is a planning problem, and its [[schedule]] is the fixed part; without an adaptive policy it is refused
/// unless allow_unplanned. Paths are relative to the file. Throws InputError with the location of the error.
MissionVariant read_mission(const std::filesystem::path& path, const MissionReadOptions& reading = {});

/// The same from text; `path` names it and is where relative paths start.
MissionVariant parse_mission(std::string_view text, const std::filesystem::path& path,
                             const MissionReadOptions& reading = {});

}  // namespace flightwatt::mission
