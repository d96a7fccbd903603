#pragma once

#include "flight/flight_series.h"

#include <optional>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// ENERGY.power, else voltage times current (of ENERGY, then BAT), else the sum of the ESCs or power devices. Rejected
/// are a source that is 0 throughout, and one that voltage times current contradicts (another layout). Outliers are
/// removed.
TrackSelection select_power(const FlightSeries& series);

/// An electrical track of the batteries that a log numbers (batteries.h), without outliers. std::nullopt for other
/// tracks and logs.
std::optional<TrackSelection> select_of_batteries(const FlightSeries& series, std::string_view name);

/// The times, rising, at which the message of `source` ("ENERGY.current"; a user's CSV has no message) has a power that
/// is not its voltage times its current.
std::vector<double> contradicted_times(const FlightSeries& series, std::string_view source);

/// The throttle for detecting dropouts of power or current; empty without one, and if the track is never 0.
Track dropout_throttle(const FlightSeries& series, const Track& candidate);

}  // namespace flightwatt::flight
