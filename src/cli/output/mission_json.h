#pragma once

#include "cli/output/json_text.h"
#include "mission/simulation.h"

namespace flightwatt::cli {

/// The summary as simulate and compare print it; null stands for "never".
nlohmann::ordered_json to_json(const mission::MissionSummary& summary);

}  // namespace flightwatt::cli
