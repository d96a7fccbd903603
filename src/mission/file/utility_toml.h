#pragma once

#include "base/toml_reader.h"
#include "compute/compute_model.h"
#include "mission/utility.h"

namespace flightwatt::mission {

/// Reads the `utility` of a component:
///
///     parameter = "fps"       # default: the profile's only one; without any: `weight` while it runs
///     weight = 1.0            # 0 or more; default 1
///     shape = "linear"        # default; or "sqrt", "log" (the natural one, of 1 + QoS), or "points":
///     qos = [6, 10, 32]       # rising, around the profile's range
///     value = [0, 5, 6]       # not falling, straight lines between; `worth` is the older name
///
/// Throws InputError for what is unknown, missing, negative or not monotone.
Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile);

}  // namespace flightwatt::mission
