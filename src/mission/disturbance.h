#pragma once

#include "battery/battery.h"
#include "mission/schedule.h"

#include <filesystem>
#include <limits>
#include <vector>

namespace flightwatt::mission {

/// An unplanned change of power or battery between two mission times.
struct Disturbance {
    double start_s = 0.0;
    double end_s = std::numeric_limits<double>::infinity();
    double mechanical_factor = 1.0;
    double mechanical_w = 0.0;  ///< added after the factor
    double compute_factor = 1.0;
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;   ///< [points] lost at once, at start_s
    double capacity_factor = 1.0;    ///< of the pack, from the start on
    double resistance_factor = 1.0;  ///< the same of all its resistances
};

using Disturbances = std::vector<Disturbance>;

/// The pack as it really is.
battery::Battery apply_disturbances(battery::Battery battery, const Disturbances& disturbances);

/// The disturbances at the same part of the same phase when phases take other durations.
Disturbances rescale_to_flown_durations(Disturbances disturbances, const PerPhase<double>& planned_s,
                                        const PerPhase<double>& flown_s);

/// Reads a file of disturbances (docs/missions.md) for a mission of these durations. Throws InputError for
/// unknown keys, values out of range, segments that are empty or not within their phase, phases that are not flown,
/// and entries that change nothing.
Disturbances read_disturbances(const std::filesystem::path& path, const PerPhase<double>& duration_s);

}  // namespace flightwatt::mission
