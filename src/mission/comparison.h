#pragma once

#include "base/text_table.h"
#include "mission/simulation.h"

#include <vector>

namespace flightwatt::mission {

/// The best first: by state of charge left, then (when empty) by how long the battery lasted; those whose
/// power it cannot deliver last. Equals keep their order.
std::vector<MissionSummary> ranked(std::vector<MissionSummary> summaries);

/// A row for each mission; "-" where there is no number. Utility has a column if any mission states one, and
/// the probability to land below the reserve if flights were drawn.
TextTable comparison_table(const std::vector<MissionSummary>& ranked);

}  // namespace flightwatt::mission
