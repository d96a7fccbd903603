#pragma once

#include "mission/mission.h"

#include <optional>

namespace flightwatt::mission {

/// What a mission's schedule is worth up to `until_s` [mission time], divided by the duration of the whole
/// mission; none if the mission states no utility.
std::optional<double> mean_worth(const Mission& mission, double until_s);

}  // namespace flightwatt::mission
