#pragma once

#include "base/toml_reader.h"
#include "mission/mission.h"
#include "mission/mission_read_options.h"

#include <optional>

namespace flightwatt::mission {

/// Reads the values of [path] that a plan chooses, without `mission_with`; std::nullopt if all are fixed. Throws
/// InputError for too many combinations.
std::optional<SurveyChoices> read_survey_choices(const TomlTable& mission_table);

/// Reads [path] and [wind] of a mission file (docs/missions.md), if there is a path, and sets the path, duration and
/// mean power of the cruise. `reading` may change how much of the path is flown, and chooses lines that are not fixed; by
/// default those of the widest spacing. Throws InputError for a key missing, unknown or out of range, a path that cannot
/// be flown, and a model without a physical part; UnknownPowerError for airspeeds far beyond the range of its flights.
void read_cruise_path(const TomlTable& mission_table, const MissionReadOptions& reading, MissionSetup& mission);

}  // namespace flightwatt::mission
