#pragma once

#include "base/toml_reader.h"
#include "compute/compute_model.h"
#include "mission/mission.h"

namespace flightwatt::mission {

/// Reads the [plan] of a mission; all of it may be left out:
///
///     slot_s = 10                            # quality may change every so many seconds of a phase
///     dwell_s = 30                           # and then stays at least so long; default 0
///     may_be_off = ["encryption"]            # components that may be switched off; default: none
///     levels = { detection = { fps = [6, 10] } }  # what may be chosen; default: what was profiled
///
/// Throws InputError for a slot that is not positive, unknown names, and levels out of a profile's range.
PlanSettings read_plan_settings(const TomlTable& mission, const compute::ComputeModel& compute);

}  // namespace flightwatt::mission
