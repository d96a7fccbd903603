#pragma once

#include "flight/flight_series.h"

#include <optional>
#include <string_view>

namespace flightwatt::flight {

/// An electrical track (power_w, voltage_v, current_a, charge_ah, energy_wh), not cleaned, of a log that numbers its
/// batteries: sums over those that draw current, at the voltage of the one that draws most. Spare inputs and circuits
/// of another voltage are named. std::nullopt for other tracks and logs.
std::optional<TrackSelection> battery_track(const FlightSeries& series, std::string_view name);

}  // namespace flightwatt::flight
