#pragma once

#include "helpers/made_up_paths.h"
#include "helpers/steady_mission.h"

#include <utility>

namespace flightwatt::test {

/// The steady mission's battery on a path, with nothing that runs.
inline mission::Mission path_mission(path::FlightPath path, const path::Wind& wind = {}) {
    auto mission = steady_mission();
    mission.setup.mechanical->physical = made_up_wing();
    mission.setup.cruise_path = made_up_cruise(std::move(path), wind);
    mission.setup.cruise_level = mechanical::ConstantPower{mean_power_w(*mission.setup.cruise_path), std::nullopt, 0.0};
    const double cruise_s = duration_s(*mission.setup.cruise_path);
    mission.setup.duration_s[flight::Phase::cruise] = cruise_s;
    mission.setup.duration_is_stated[flight::Phase::cruise] = true;
    mission.schedule = {{flight::Phase::cruise, 0.0, cruise_s, {}}};
    return mission;
}

}  // namespace flightwatt::test
