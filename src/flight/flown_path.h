#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <vector>

namespace flightwatt::flight {

/// A point of a flown path, with the motion from the previous point.
struct FlownWaypoint {
    double east_m = 0.0;   ///< from the first point; in geographic paths latitude_deg
    double north_m = 0.0;  ///< from the first point; in geographic paths longitude_deg
    double altitude_m = 0.0;
    double duration_s = 0.0;  ///< from the previous point; 0 for the first
    /// Cube root of the mean cube, as the power of drag follows the cube; of rotorcraft the speed over ground and up,
    /// which their missions keep.
    double airspeed_m_per_s = 0.0;
};

/// The path of a phase as a list of waypoints.
struct FlownPath {
    bool is_geographic = false;  ///< positions in degrees, since the log has none in metres
    std::vector<FlownWaypoint> waypoints;
};

/// Returns the path of a phase: points about every 30 s (the interval of the physical fit), and in between as many as
/// straight lines need to stay within 3 m of the ground track. Airspeed is the mean of each interval, altitude is
/// linear in it: faster changes exchange height and speed. Throws InputError without altitude or position, and without
/// the airspeed of what is no rotorcraft.
FlownPath flown_path(const FlightData& data, const PhaseSpan& phase);

}  // namespace flightwatt::flight
