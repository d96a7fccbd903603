#pragma once

#include "mechanical/mechanical_model.h"

#include <optional>
#include <vector>

namespace flightwatt::mission {

/// Standard deviations between flights that a mission states itself; what it does not state is looked for in
/// its models.
struct Uncertainty {
    flight::PerPhase<std::optional<double>> level_sd_percent;  ///< of the phase's mean mechanical power
    flight::PerPhase<std::optional<double>> duration_sd_s;
    std::vector<std::optional<double>> compute_sd_percent;  ///< of each component's power
    std::optional<double> capacity_sd_percent;              ///< of the battery's capacity
};

}  // namespace flightwatt::mission
