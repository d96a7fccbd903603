#pragma once

#include "mechanical/physical_model.h"
#include "path/path.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::path {

/// A part of a flight with one motion through the air.
struct TrajectorySegment {
    double time_s = 0.0;  ///< its duration
    /// The motion; its load factor is the root of the mean square, so that the mean of a power that follows the square
    /// is exact.
    mechanical::FlightState motion;
    std::size_t element = 0;  ///< index in the path
};

/// A path as it is flown in a wind.
struct PathTrajectory {
    std::vector<TrajectorySegment> pieces;         ///< in order of time, none shorter than 0 s
    std::vector<double> element_s;                 ///< duration of each element
    double duration_s = 0.0;                       ///< duration of all
    std::vector<std::size_t> infeasible_elements;  ///< elements that the wind forbids, with the policy `crawl`
};

/// Treatment of elements that the wind forbids.
enum class InfeasibleLegPolicy {
    refuse,  ///< throw InputError
    crawl    ///< note it in `infeasible_elements`, and fly the element with a ground speed of 2 % of the airspeed
};

/// Flies a path in a steady wind: airspeed, or the speed over ground, is held, the course over ground kept by a drift
/// angle (docs/methods.md, Eqs. 40 and 41). Around circles ground speed and bank change, which is integrated. Throws InputError, placed at the
/// element, for one that the wind forbids, that is too short or too steep for its climb, or for a path of more than
/// 1e7 s.
PathTrajectory compute_trajectory(const FlightPath& path, const Wind& wind,
                                  InfeasibleLegPolicy infeasible_legs = InfeasibleLegPolicy::refuse);

/// Returns the horizontal ground speed [m/s] of an element on a course over ground in a wind, while it climbs or
/// descends; std::nullopt if no drift angle keeps the course, or the aircraft would be blown back.
std::optional<double> ground_speed_m_per_s(const PathElement& element, double climb_m_per_s, double course_deg,
                                           const Wind& wind);

/// Returns whether a path ends where it starts.
bool returns_to_start(const FlightPath& path);

/// Returns the path flown `times` times, from its end straight back to its start before each time but the first; the
/// last time up to a fraction of its duration in the wind, and from there straight back if the path itself ends at its
/// start. Heights too large for such a way at the rates, if known, change above the start. Throws as
/// compute_trajectory().
FlightPath repeated(const FlightPath& path, const Wind& wind, double times, const ClimbRates& rates = {});

/// Returns the position on a path at a time from its start, at most its duration.
PathPosition position_at(const PathTrajectory& flown, double time_s);

/// Returns the remainder of a path from a position, which may have been determined in another wind.
PathTrajectory remaining_trajectory(const PathTrajectory& flown, const PathPosition& place);

}  // namespace flightwatt::path
