#pragma once

#include "live/live_flight.h"

#include <optional>
#include <string>

namespace flightwatt::live {

/// What was known of a flight in the air when its clock began anew: the log or the aircraft restarted.
struct CarriedFlight {
    double clock_s = 0.0;  ///< of the clock before
    std::optional<double> energy_wh = {};
    std::optional<double> soc_percent = {};
    std::optional<double> counted_wh = {};  ///< by the autopilot's counters then
    std::optional<double> counted_ah = {};
};

/// From the state of a flight in the air, and the series that it is of.
CarriedFlight carried_flight(const LiveState& state, const flight::SelectedTracks& tracks);

/// Adds what was known before to a state whose series begins in the air. The counters fill the time between: one that
/// goes on by its difference, one that began anew with the aircraft by all it has counted. Without one, energy is
/// unknown, and the charge is that of the voltage. A warning says which. `battery`: none, if there is none.
void continue_flight(const CarriedFlight& before, const flight::SelectedTracks& tracks, double now_s,
                     const std::optional<battery::Battery>& battery, LiveState& state);

}  // namespace flightwatt::live
