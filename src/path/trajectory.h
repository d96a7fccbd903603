#pragma once

#include "mechanical/physical_model.h"
#include "path/path.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::path {

/// A part of a flight with one motion through the air.
struct TrajectorySegment {
    double time_s = 0.0;  ///< how long it lasts
    /// Its load factor is the root of the mean square, which makes the mean of a power that follows the square exact.
    mechanical::FlightState motion;
    std::size_t element = 0;
};

/// A path as it is flown in a wind.
struct PathTrajectory {
    std::vector<TrajectorySegment> pieces;         ///< in order, none shorter than 0 s
    std::vector<double> element_s;                 ///< how long each element takes
    double duration_s = 0.0;                       ///< of all
    std::vector<std::size_t> infeasible_elements;  ///< that the wind forbids, if that was asked for
};

/// What to do where the wind forbids an element.
enum class InfeasibleLegPolicy {
    refuse,  ///< throw InputError
    crawl  ///< note it in `infeasible_elements`, and fly the element with 2 % of the airspeed over ground, which is as good as none
};

/// Flies a path in a steady wind: airspeed is held, the course over ground kept by a drift angle (docs/methods.md,
/// Eqs. 40 and 41). Around circles ground speed and bank change, which is integrated. Throws InputError, placed at the
/// element, for one that the wind forbids, that is too short or too steep for its climb, or for a path of more than
/// 1e7 s.
PathTrajectory compute_trajectory(const FlightPath& path, const Wind& wind,
                                  InfeasibleLegPolicy infeasible_legs = InfeasibleLegPolicy::refuse);

/// Ground speed [m/s] in a wind, of level flight with a course over ground; none where the drift angle that it takes
/// does not exist, or the aircraft would be blown back.
std::optional<double> ground_speed_m_per_s(double airspeed_m_per_s, double course_deg, const Wind& wind);

/// Where a path is after a time from its start, at most its duration.
PathPosition position_at(const PathTrajectory& flown, double time_s);

/// The remainder of a path from a position, which may have been determined in another wind.
PathTrajectory remaining_trajectory(const PathTrajectory& flown, const PathPosition& place);

}  // namespace flightwatt::path
