#pragma once

#include "mission/simulation/load_segments.h"

#include <vector>

namespace flightwatt::mission {

/// A flight that was drawn.
struct SampledFlight {
    const MissionSetup& setup;
    battery::Battery battery;  ///< disturbed
    std::vector<LoadSegment> segments;
};

/// How one flight ended.
struct FlightOutcome {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool battery_failure = false;  ///< that, or cut off, or beyond the power limit, or on a path that the wind forbids
    /// What is left [points]; after a failure less than 0, by the energy demanded later as a part of a full battery's.
    double remaining_percent = 0.0;
    std::vector<double> soc_percent;  ///< at the times that were asked for
};

/// Follows the charge through the segments and notes it at `times_s`.
FlightOutcome simulate_flight(const SampledFlight& flight, const std::vector<double>& times_s = {});

/// A flight lands below the reserve too where its battery failed, with whatever charge.
inline bool misses_reserve(const FlightOutcome& landing, double reserve_soc_percent) {
    return landing.battery_failure || landing.final_soc_percent < reserve_soc_percent;
}

}  // namespace flightwatt::mission
