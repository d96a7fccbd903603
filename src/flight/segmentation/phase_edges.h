#pragma once

#include "flight/flight_phases.h"
#include "flight/segmentation/flight_grid.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// Interval between two rests: motion, or a running motor.
struct Activity {
    IndexSpan moving;
    IndexSpan span;                         ///< with the adjacent ends of the rests, which include the last metres
    std::optional<double> ground_before_m;  ///< absent at the beginning of the log, or after a jump
    std::optional<double> ground_after_m;   ///< absent at the end of the log, or before a jump
};

/// The activities of the grid, piece by piece, in order.
std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<IndexSpan>& rests,
                                      const SegmentationOptions& options);

/// Ground level on both sides. If they differ by more than a third of the height (an estimator without a fix), the
/// later one is used.
struct GroundLevels {
    double before_m = 0.0;
    double after_m = 0.0;
    bool disagreed = false;
};

/// `planned_ground_m` is used if the activity has no rest on either side.
GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m);

/// Heights of an activity above the ground, which changes linearly from before to after.
struct Heights {
    std::vector<double> height_m;  ///< of activity.span
    double ground_m = 0.0;
    double cruise_height_m = 0.0;  ///< median of the upper half
    double max_m = 0.0;
};

Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds);

/// Above this fraction of the flight's height an aircraft is in the air.
inline constexpr double airborne_fraction = 0.25;
/// A climb continues at this fraction of its mean rate, or more.
inline constexpr double least_of_climb = 0.25;
/// A height held for this time before the landing is one of work, however low [s].
inline constexpr double min_work_hold_s = 90.0;
/// So is a height in the upper half of the flight that is held for this fraction of the longest earlier hold.
inline constexpr double min_work_hold_fraction = 0.5;

/// The edges of one sortie; absent if the log begins or ends in the air.
struct SortieEdges {
    std::optional<double> lift_off_s;
    std::optional<double> takeoff_end_s;
    std::optional<double> landing_start_s;
    std::optional<double> touchdown_s;
};

SortieEdges find_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options);

}  // namespace flightwatt::flight
