#pragma once

#include "flight/flight_phases.h"
#include "flight/segment/flight_grid.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace flightwatt::flight {

/// The ground level at a rest next to a flight: the median of its known altitudes, and how far they wander.
struct GroundLevel {
    double altitude_m = 0.0;
    double wander_m = 0.0;
};

/// An interval between two rests: motion, or a running motor.
struct Activity {
    IndexSpan moving;
    IndexSpan span;  ///< the same with the adjacent ends of the rests, which include the last metres
    std::optional<GroundLevel> ground_before = {};  ///< absent without a rest there (at the beginning of the log, or
    std::optional<GroundLevel> ground_after = {};   ///< after a jump), and in a rest without an altitude

    bool begins_at_rest() const { return span.begin < moving.begin; }
    bool ends_at_rest() const { return span.end > moving.end; }
};

/// Finds the activities between the rests of the grid, in order; none extends over a jump of the altitude.
std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<IndexSpan>& rests,
                                      const SegmentationOptions& options);

/// The ground levels on both sides of an activity, between which heights are measured. If they differ by more than a
/// third of the height and by more than they wander, both are the later one, and `lift_off_m` is the one before.
/// `wander_m` includes jumps in flight.
struct GroundLevels {
    double before_m = 0.0;
    double after_m = 0.0;
    double wander_m = 0.0;
    std::optional<double> lift_off_m = {};
};

/// Returns the ground levels of an activity; that of `planned_ground_m` if it has no rest on either side.
GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m);

/// Minimum airspeed of a fixed wing in flight, without it minimum ground speed [m/s].
inline constexpr double min_flight_m_per_s = 5.0;
/// Fraction of the flight's height above which an aircraft is in the air.
inline constexpr double airborne_fraction = 0.25;

/// Heights of an activity above the ground, which changes linearly from before to after.
struct Heights {
    std::vector<double> height_m;  ///< at each point of activity.span
    double ground_m = 0.0;
    double lift_off_m = 0.0;       ///< of the ground before, in terms of height_m
    double cruise_height_m = 0.0;  ///< median of the upper half
    double max_m = 0.0;
    double wander_m = 0.0;  ///< see GroundLevels

    /// Returns whether the altitude wanders at rest by more than a rest allows, and by as much as shows an aircraft in
    /// the air.
    bool are_unknown() const {
        return wander_m > std::max(SegmentationOptions{}.rest_height_m, airborne_fraction * cruise_height_m);
    }
};

/// Returns the heights of an activity.
Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds);

/// Fraction of its mean rate at which, or above, a climb continues.
inline constexpr double least_of_climb = 0.25;
/// Time [s] for which a height must be held before the landing to be part of the cruise, however low it is.
inline constexpr double min_work_hold_s = 90.0;
/// Fraction of the longest earlier hold for which a height in the upper half must be held to be part of the cruise.
inline constexpr double min_work_hold_fraction = 0.5;

/// The edges of one sortie; absent if the log begins or ends in the air.
struct SortieEdges {
    std::optional<double> lift_off_s;
    std::optional<double> takeoff_end_s;
    std::optional<double> landing_start_s;
    std::optional<double> touchdown_s;
};

/// Finds the edges of a sortie by the heights of an activity.
SortieEdges find_edges(const ResampledFlight& grid, const Activity& activity, const Heights& heights,
                       const SegmentationOptions& options);

}  // namespace flightwatt::flight
