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

/// Returns whether an altitude is above sea level by its source: a position of the autopilot or a receiver, or the
/// altitude_m of a plain CSV. Others are above the ground or the first position, or of a barometer without the day's
/// pressure.
bool is_above_sea(const Track& altitude);

}  // namespace flightwatt::flight
