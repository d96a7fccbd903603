#pragma once

#include "flight/flight_series.h"

namespace flightwatt::flight {

/// The series as it would have been read from a log that ends at `until_s` (the log's own seconds), in every
/// field: nothing later is left. What is known before a flight stays.
FlightSeries cut_series(const FlightSeries& series, double until_s);

}  // namespace flightwatt::flight
