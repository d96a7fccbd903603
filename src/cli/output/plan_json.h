#pragma once

#include "cli/output/json_text.h"
#include "mission/feasibility_limits.h"

namespace flightwatt::cli {

/// A plan; null stands for what an infeasible one does not have.
nlohmann::ordered_json to_json(const mission::MissionPlan& plan, const mission::MissionSetup& mission);

nlohmann::ordered_json to_json(const mission::InfeasibilityReport& report);

}  // namespace flightwatt::cli
