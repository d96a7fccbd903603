#pragma once

#include "flight/flight_phases.h"
#include "live/live_flight.h"
#include "path/path_tracker.h"

#include <optional>

namespace flightwatt::live {

/// The rest of a flight whose telemetry begins in the air, from what was seen of its cruise since. Where its cruise had
/// begun before, and nobody says how much of it is left, that is evenly likely from nothing to all but what was seen:
/// half of it is expected, and the interval holds the rest. The level is the model's mean, moved by what was seen. The
/// battery goes on from its state; `places` finds where on its path it is. Throws NoResultError before 30 s of cruise
/// were seen, and as predict_energy.
Prediction predict_airborne_start(const PredictionInput& basis, const flight::FlightSeries& series,
                                  const flight::Sortie& sortie, const LiveBattery* battery, path::PathTracker* places,
                                  Diagnostics& remarks);

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
