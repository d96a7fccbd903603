#pragma once

#include "base/toml_reader.h"
#include "compute/compute_model.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Reads the [uncertainty] of a mission; all of it may be left out, and each says how flights differ where
/// the models do not, or other than they do:
///
///     level_sd_percent = { cruise = 5 }       # of the phase's mean mechanical power
///     duration_sd_s = { cruise = 20 }
///     compute_sd_percent = { detection = 2 }  # of the component's power
///     capacity_sd_percent = 3                 # of the battery's capacity
///
/// Throws InputError for unknown phases and components, levels without a mechanical model, and what is
/// negative.
Uncertainty read_uncertainty(const TomlTable& mission, const compute::ComputeModel& compute,
                             bool has_mechanical);

}  // namespace flightwatt::mission
