#pragma once

#include "path/plans/flight_plan.h"

#include <map>
#include <string>
#include <vector>

namespace flightwatt::path {

/// The state that one block leaves for the next.
struct BlockState {
    std::vector<PathEntry> entries;        ///< movements of all blocks so far
    std::map<std::string, double> values;  ///< settings, and values set by the stages
};

/// What of a block is not flown.
struct BlockRemarks {
    std::vector<std::string> all;      ///< as PlanEntries::not_flown
    std::vector<std::string> missing;  ///< as PlanEntries::missing
};

/// Appends the movements of a block to the entries, and returns texts about the parts that are not flown. Throws
/// InputError, placed at the stage, for one that cannot be read.
BlockRemarks read_block(const FlightPlan& plan, const pugi::xml_node& block, const AutopilotSettings& settings,
                        BlockState& state);

}  // namespace flightwatt::path
