#pragma once

#include "path/plan_files.h"
#include "path/trajectory.h"

namespace flightwatt::fuzz {

/// Flies the movements of a plan in a wind.
inline void fly(const path::PlanEntries& plan) {
    path::PathDefaults defaults;
    defaults.airspeed_m_per_s = 13.0;
    defaults.altitude_m = 100.0;
    defaults.starts_at_first_place = plan.starts_at_first_place;
    path::compute_trajectory(path::build_path(plan.entries, defaults), {4.0, 250.0});
}

}  // namespace flightwatt::fuzz
