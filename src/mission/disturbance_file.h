#pragma once

#include "mission/disturbance.h"

#include <filesystem>
#include <vector>

namespace flightwatt::mission {

/// Reads a file of disturbances:
///
///     [[disturbance]]                 # stronger wind
///     phase = "cruise"                # default: the whole mission
///     from = 100                      # seconds since the phase (or the mission) began, or "40 %" of it
///     to = "60 %"                     # default: its end
///     mechanical_factor = 1.1         # and mechanical_w, compute_factor, compute_w, in any combination
///
///     [[disturbance]]                 # a weaker pack, from the beginning on
///     capacity_factor = 0.95          # and resistance_factor
///
///     [[disturbance]]                 # a sudden drop
///     phase = "cruise"
///     at = 300                        # as `from`
///     soc_drop_percent = 3
///
/// Durations are the mission's. Throws InputError for unknown keys, values out of range, segments that are
/// empty or not within their phase, phases that are not flown, and entries that change nothing.
std::vector<Disturbance> read_disturbances(const std::filesystem::path& path,
                                           const flight::PerPhase<double>& duration_s);

}  // namespace flightwatt::mission
