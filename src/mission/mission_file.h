#pragma once

#include "mission/mission.h"
#include "mission/mission_read_options.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace flightwatt::mission {

/// Reads a mission file (docs/missions.md). A mission with [plan], an adaptive policy, or components and no
/// [[schedule]] is a planning problem, and its [[schedule]] is the fixed part; without an adaptive policy it is refused
/// unless allow_unplanned. Paths are relative to the file. Throws InputError with the location of the error, a path of
/// unknown power UnknownPowerError.
MissionVariant read_mission(const std::filesystem::path& path, const MissionReadOptions& reading = {});

/// Reads a mission from text as read_mission(). `path` names it, and relative paths begin in its folder.
MissionVariant parse_mission(std::string_view text, const std::filesystem::path& path,
                             const MissionReadOptions& reading = {});

/// Reads a mission's file with given options.
using MissionLoader = std::function<MissionVariant(const MissionReadOptions&)>;

/// Reads a mission as parse_mission(); that with another duration of its cruise without reading its files again. Of one
/// thread.
MissionLoader mission_loader(std::string text, std::filesystem::path path);

}  // namespace flightwatt::mission
