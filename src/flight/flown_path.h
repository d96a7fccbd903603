#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <vector>

namespace flightwatt::flight {

/// Where an aircraft was, and how it came there from the place before.
struct FlownWaypoint {
    double east_m = 0.0;   ///< from the first place; or latitude_deg
    double north_m = 0.0;  ///< or longitude_deg
    double altitude_m = 0.0;
    double duration_s = 0.0;        ///< since the place before; 0 for the first
    double airspeed_m_per_s = 0.0;  ///< the root of the mean cube meanwhile, as drag's power follows the cube
};

struct FlownPath {
    bool is_geographic = false;  ///< places in degrees: the log has none in metres
    std::vector<FlownWaypoint> waypoints;
};

/// The path of a phase: a place every 30 s or so (what the power of motion is fitted over), and between as many as
/// straight lines need to stay within 3 m of the track over ground. Airspeed is the mean of the 30 s, altitude linear
/// in them: what changes faster is an exchange of height and speed. Throws InputError where the log measured no
/// airspeed, no altitude or no position.
FlownPath flown_path(const FlightSeries& series, const PhaseSpan& phase);

}  // namespace flightwatt::flight
