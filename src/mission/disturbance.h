#pragma once

#include "mission/load_segments.h"

#include <limits>
#include <vector>

namespace flightwatt::mission {

/// What happens to a flight that nobody planned for, from one mission time to another.
struct Disturbance {
    double from_s = 0.0;
    double to_s = std::numeric_limits<double>::infinity();
    double mechanical_factor = 1.0;
    double mechanical_w = 0.0;  ///< added to what the factor makes of the power
    double compute_factor = 1.0;
    double compute_w = 0.0;
    double soc_drop_percent = 0.0;   ///< [points] lost at once, at from_s
    double capacity_factor = 1.0;    ///< of the pack, from the beginning on
    double resistance_factor = 1.0;  ///< the same of all its resistances
};

/// The demands, cut where a disturbance begins or ends and changed in between. Without mechanical power there
/// is none to disturb.
std::vector<Demand> disturbed(const std::vector<Demand>& demands,
                              const std::vector<Disturbance>& disturbances);

/// The pack as it really is.
battery::Battery disturbed(battery::Battery battery, const std::vector<Disturbance>& disturbances);

/// Where a time of a mission lies when its phases take other durations: at the same part of the same phase.
double at_same_part_s(double time_s, const flight::PerPhase<double>& planned_s,
                      const flight::PerPhase<double>& flown_s);

/// The same for all their times.
std::vector<Disturbance> at_same_part(std::vector<Disturbance> disturbances,
                                      const flight::PerPhase<double>& planned_s,
                                      const flight::PerPhase<double>& flown_s);

/// The same for a schedule.
std::vector<Stretch> at_same_part(std::vector<Stretch> schedule, const flight::PerPhase<double>& planned_s,
                                  const flight::PerPhase<double>& flown_s);

}  // namespace flightwatt::mission
