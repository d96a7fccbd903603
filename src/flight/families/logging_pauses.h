#pragma once

#include "flight/flight_series.h"

#include <vector>

namespace flightwatt::flight {

/// Splits a recording at each pause of more than a minute after which another pack is used: the charge counter restarts,
/// or the voltage has risen by more than 5 % at a current of half of that before, or more. Each part has the clock of
/// all; those behind the first have a note.
std::vector<FlightSeries> split_at_pauses(FlightSeries series);

}  // namespace flightwatt::flight
