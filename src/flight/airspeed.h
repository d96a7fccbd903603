#pragma once

#include "flight/flight_series.h"

#include <optional>

namespace flightwatt::flight {

/// The mean of airspeed^3 [m^3/s^3] of the samples in [start_s, end_s]: gusts count, as they do for drag.
/// std::nullopt if fewer than half of the seconds between have a sample within 5 s.
std::optional<double> mean_cubed_airspeed_m3_per_s3(const Track& airspeed, double start_s, double end_s);

}  // namespace flightwatt::flight
