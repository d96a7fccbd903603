#pragma once

#include "flight/flight_data.h"

#include <optional>

namespace flightwatt::flight {

/// Chooses the track of each quantity and removes outliers: by a rule of its own, else the first candidate that varies,
/// else the first with values. Each choice may use those above it in select.cpp, none below it. What the log states is
/// never guessed; measured and stated goes before measured, derived and assumed.
FlightData select_tracks(const FlightSeries& series);

/// Returns the altitude of the ground that the log or the flight plan states.
std::optional<double> stated_ground_altitude_m(const FlightData& data);

}  // namespace flightwatt::flight
