#pragma once

#include "mission/mission.h"
#include "mission/simulation/load_segments.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace flightwatt::mission {

/// A drawn flight.
struct DrawnFlight {
    MissionSetup setup;
    std::vector<LoadSegment> segments;
    std::vector<double> times_s = {};  ///< at which its charge is noted: rising, and segments start there
};

/// How one flight ended.
struct FlightOutcome {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool battery_failure = false;  ///< that, or cut off, or beyond the power limit, or on a path that the wind forbids
    /// Final charge [points]; after a failure minus the later demand, as a fraction of the full energy.
    double remaining_percent = 0.0;
    std::vector<double> soc_percent;  ///< at the times that were asked for
};

/// A battery failure counts as below the reserve at any charge.
inline bool misses_reserve(const FlightOutcome& landing, double reserve_soc_percent) {
    return landing.battery_failure || landing.final_soc_percent < reserve_soc_percent;
}

/// Draws flight number `number` onto `flight`, which is the mission or another flight of it: copying less is faster.
using FlightDraw = std::function<void(std::size_t number, DrawnFlight& flight)>;

/// One flight, through its segments as advance_segment() does.
FlightOutcome simulate_flight(const DrawnFlight& flight);

/// Flights of a mission from number `first` on, on all threads. The result of a flight depends on its number alone.
std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count);

}  // namespace flightwatt::mission
