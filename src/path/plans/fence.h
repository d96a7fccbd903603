#pragma once

#include "path/plan_fence.h"
#include "path/plans/json_text.h"

namespace flightwatt::path {

/// Reads the geofence of a plan of QGroundControl; its circles become polygons around them.
PlanFence read_fence(const Json& plan);

}  // namespace flightwatt::path
