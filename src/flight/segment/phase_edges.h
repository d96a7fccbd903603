#pragma once

#include "flight/flight_phases.h"
#include "flight/segment/flight_grid.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace flightwatt::flight {

/// Ground level of a rest next to a flight: the median of what is known of it there, and how far it wanders.
struct GroundLevel {
    double altitude_m = 0.0;
    double wander_m = 0.0;
};

/// Interval between two rests: motion, or a running motor.
struct Activity {
    IndexSpan moving;
    IndexSpan span;  ///< with the adjacent ends of the rests, which include the last metres
    std::optional<GroundLevel> ground_before = {};  ///< absent without a rest there (at the beginning of the log, or
    std::optional<GroundLevel> ground_after = {};   ///< after a jump), and in a rest without an altitude

    bool begins_at_rest() const { return span.begin < moving.begin; }
    bool ends_at_rest() const { return span.end > moving.end; }
};

/// The activities of the grid, piece by piece, in order.
std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<IndexSpan>& rests,
                                      const SegmentationOptions& options);

/// Ground level on both sides. If they differ by more than a third of the height, and more than they wander (an
/// estimator without a fix), the later one is used. `wander_m` includes jumps in flight.
struct GroundLevels {
    double before_m = 0.0;
    double after_m = 0.0;
    double wander_m = 0.0;
    bool disagreed = false;
};

/// `planned_ground_m` is used if the activity has no rest on either side.
GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m);

/// Minimum speed of a fixed wing in flight, over ground where that is all there is [m/s].
inline constexpr double min_flight_m_per_s = 5.0;
/// Above this fraction of the flight's height an aircraft is in the air.
inline constexpr double airborne_fraction = 0.25;

/// Heights of an activity above the ground, which changes linearly from before to after.
struct Heights {
    std::vector<double> height_m;  ///< of activity.span
    double ground_m = 0.0;
    double cruise_height_m = 0.0;  ///< median of the upper half
    double max_m = 0.0;
    double wander_m = 0.0;  ///< see GroundLevels

    /// Whether the altitude wanders at rest by more than a rest allows, and as much as shows an aircraft in the air.
    bool are_unknown() const {
        return wander_m > std::max(SegmentationOptions{}.rest_height_m, airborne_fraction * cruise_height_m);
    }
};

Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds);

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
