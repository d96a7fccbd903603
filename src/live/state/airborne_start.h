#pragma once

#include "flight/flight_phases.h"
#include "live/live_flight.h"
#include "live/state/path_tracker.h"

namespace flightwatt::live {

/// The rest of a flight whose telemetry begins in the air, from what was seen of its cruise since. Where its cruise had
/// begun before, and nobody says how much of it is left, that is evenly likely from nothing to all but what was seen:
/// half of it is expected, and the interval holds the rest. The level is the model's mean, moved by what was seen. The
/// battery goes on from its state; `places` finds where on its path it is. Throws NoResultError before 30 s of cruise
/// were seen, and as predict_energy.
Prediction predict_airborne_start(const PredictionInput& basis, const flight::FlightSeries& series,
                                  const flight::Sortie& sortie, const LiveBattery* battery, PathTracker* places,
                                  Diagnostics& remarks);

}  // namespace flightwatt::live
