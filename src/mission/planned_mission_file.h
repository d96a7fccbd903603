#pragma once

#include "mission/mission.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace flightwatt::mission {

/// The mission file `text` (of `path`) with `schedule` in the place of its [plan], [policy] and [[schedule]];
/// everything else says what it said, its keys sorted and without comments. The files that it names are found
/// from `folder`, where the result is to stand.
std::string planned_mission_toml(std::string_view text, const std::filesystem::path& path,
                                 const Mission& planned, const std::filesystem::path& folder);

}  // namespace flightwatt::mission
