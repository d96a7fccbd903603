#pragma once

#include "flight/flight_phases.h"
#include "flight/flight_series.h"

#include <vector>

namespace flightwatt::flight {

/// Where an aircraft was, and how it came there from the place before.
struct FlownPlace {
    double east_m = 0.0;   ///< from the first place; or latitude_deg
    double north_m = 0.0;  ///< or longitude_deg
    double altitude_m = 0.0;
    double duration_s = 0.0;        ///< since the place before; 0 for the first
    double airspeed_m_per_s = 0.0;  ///< the root of the mean cube meanwhile, as drag's power follows the cube
};

struct FlownPath {
    bool is_geographic = false;  ///< places in degrees: the log has none in metres
    std::vector<FlownPlace> places;
};

/// The path of a phase, a place every 30 s (what the power of motion is fitted over) and one at its end. Throws
/// InputError where the log measured no airspeed, no altitude or no position.
FlownPath flown_path(const FlightSeries& series, const PhaseSpan& phase);

}  // namespace flightwatt::flight
