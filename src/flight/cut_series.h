#pragma once

#include "flight/flight_series.h"

namespace flightwatt::flight {

/// What the series held at `until_s` (the log's own seconds): nothing later is left, in no channel, track or
/// witness. Values that are interpolated between a sample before and one after (channels other than power
/// and what its message carries) are kept; what uses a cut series takes altitude, speed and airspeed from
/// their own tracks, which are exact. The planned ground altitude is known before a flight and stays.
FlightSeries cut_series(const FlightSeries& series, double until_s);

}  // namespace flightwatt::flight
