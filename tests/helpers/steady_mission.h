#pragma once

#include "mission/mission.h"

namespace flightwatt::test {

/// A cruise of 20 W over 1000 s from 36 kJ, which takes 55.6 points.
inline mission::Mission steady_mission() {
    mission::Mission mission;
    mission.setup.name = "steady";
    mission.setup.duration_s[flight::Phase::cruise] = 1000.0;
    mission.setup.battery = {"", 10.0, 0.0, 1.0};
    mission.schedule = {{flight::Phase::cruise, 0.0, 1000.0, {}}};
    mission.setup.mechanical = mechanical::MechanicalModel();
    mission.setup.mechanical->phases[flight::Phase::cruise].fourier = {0.01, 20.0, {}, {}};
    mission.setup.mechanical->phases[flight::Phase::cruise].duration_s = 1000.0;
    return mission;
}

}  // namespace flightwatt::test
