#pragma once

#include "flight/flight_phases.h"
#include "flight/segmentation/flight_grid.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// What lies between two rests: something moved, or the motor ran.
struct Activity {
    IndexSpan moving;
    IndexSpan span;                         ///< with the ends of the rests beside it, which reach up to the last metres
    std::optional<double> ground_before_m;  ///< absent if the log (or its altitude, after a jump) begins with it
    std::optional<double> ground_after_m;   ///< absent if it ends with it
};

/// The activities of the grid, piece by piece, in order.
std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<IndexSpan>& rests,
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

/// A height that is held for so long before the landing is worked at, however low [s].
inline constexpr double min_work_hold_s = 90.0;
/// So is one, in the upper half of the flight, that is held for this part of the longest hold before it.
inline constexpr double min_work_hold_fraction = 0.5;

/// The edges of one sortie; absent where the log begins or ends in the air.
struct SortieEdges {
    std::optional<double> lift_off_s;
    std::optional<double> takeoff_end_s;
    std::optional<double> landing_start_s;
    std::optional<double> touchdown_s;
    std::vector<HeldAltitude> held;  ///< see Sortie
};

SortieEdges find_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options);

}  // namespace flightwatt::flight
