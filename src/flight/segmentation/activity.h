#pragma once

#include "flight/flight_phases.h"
#include "flight/segmentation/flight_grid.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// What lies between two rests: something moved, or the motor ran.
struct Activity {
    GridSpan moving;
    GridSpan span;                          ///< with the ends of the rests beside it, which reach up to the last metres
    std::optional<double> ground_before_m;  ///< absent if the log (or its altitude, after a jump) begins with it
    std::optional<double> ground_after_m;   ///< absent if it ends with it
};

/// The activities of the grid, piece by piece, in order.
std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<GridSpan>& rests,
                                      const SegmentationOptions& options);

/// The ground on both sides. An estimator without a fix rests at any level: where the two differ by more than
/// a third of the height flown, the later one counts.
struct GroundLevels {
    double before_m = 0.0;
    double after_m = 0.0;
    bool disagreed = false;
};

/// `planned_ground_m` counts where the activity has no rest on either side.
GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m);

/// The heights of one activity above its ground; the ground rises or falls evenly from before to after.
struct Heights {
    std::vector<double> height_m;  ///< of activity.span
    double ground_m = 0.0;
    double cruise_height_m = 0.0;  ///< median of the upper half: the flight's own height
    double max_m = 0.0;
};

Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds);

}  // namespace flightwatt::flight
