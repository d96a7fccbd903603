#pragma once

#include "base/error.h"
#include "path/area.h"

#include <optional>

namespace flightwatt::mission {

/// A path that can be flown, at airspeeds so far beyond those of the model's flights that its power is unknown.
class UnknownPowerError : public InputError {
    using InputError::InputError;
};

/// Options of reading a mission.
struct MissionReadOptions {
    bool allow_unplanned = false;         ///< accepts a mission that is not planned yet
    std::optional<double> cruise_s = {};  ///< duration of the cruise, instead of the file's
    // Changes of a path: turns of its last circles; distance along the legs after which it returns; how often it is
    // flown.
    std::optional<double> circles = {};
    std::optional<double> return_after_m = {};
    std::optional<double> path_times = {};
    std::optional<path::SurveyLayout> survey = {};  ///< of a path whose lines are chosen: this choice
    bool counts_written_heights = false;  ///< take-off and landing are of the heights that a written plan would state
};

}  // namespace flightwatt::mission
