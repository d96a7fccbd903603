#pragma once

#include "flight/flight_series.h"

#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// ENERGY.power, else voltage times current (ENERGY, then BAT), else the ESCs' or power devices' sum. A
/// source that reads 0 throughout measures nothing and is passed over, one that voltage times current
/// contradicts has another layout than was assumed. Samples that cannot be are left out (outliers.h).
TrackSelection select_power(const FlightSeries& series);

/// The times, rising, at which the message of `source` ("ENERGY.current"; a user's CSV has no message) contradicts
/// itself: its power is not its voltage times its current.
std::vector<double> contradicted_times(const FlightSeries& series, std::string_view source);

/// The throttle that tells where a track of power or current dropped out (outliers.cpp); empty
/// without one, and where the track is nowhere 0.
Track dropout_throttle(const FlightSeries& series, const Track& candidate);

/// The 4-field ENERGY without a .log, so that the order of its last two fields was assumed: whether they fit
/// the other way round (power is voltage times current). Its tracks are then those of source
/// power_read_as_energy and energy_read_as_power.
bool energy_and_power_are_swapped(const FlightSeries& series);

}  // namespace flightwatt::flight
