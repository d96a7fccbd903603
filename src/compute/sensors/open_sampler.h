#pragma once

#include "compute/sensors/power_sampler.h"

namespace flightwatt::compute {

/// Opens a live sampler: by its kind, or the first that probing finds. A sysfs root that holds a folder sys/ (a
/// recorded tree) is entered there. Throws NoResultError if there is none, saying where it was looked for.
PowerSampler open_sampler(const SamplerSettings& settings);

/// A sampler of a program that prints watts, a number a line: one that goes on printing, each line stamped
/// when it arrives; or one that prints and exits with 0, which is started anew for every reading. It ends
/// with the sampler, its children too. Reading throws InputError for a line that is no number and
/// NoResultError when the program fails or ends without a line.
PowerSampler open_command_sampler(const SamplerSettings& settings);

}  // namespace flightwatt::compute
