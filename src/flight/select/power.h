#pragma once

#include "flight/flight_data.h"

#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Messages of consumers, each of which reports its own power.
inline constexpr const char* device_messages[] = {"ESC", "POWER_DEVICE"};

/// Returns whether the series is a user's CSV with a column of power.
bool has_plain_power(const FlightSeries& series);

/// Selects the power of a log that does not number its batteries: the column of a user's CSV, else ENERGY.power, else
/// voltage times current (of ENERGY, then BAT), else the sum of the ESCs or power devices. Rejected are a source that
/// is 0 throughout, and one that voltage times current contradicts (another layout). Outliers are removed.
ChosenTrack select_power(const FlightSeries& series);

/// Selects the sum over the ESCs; empty without one, and where it lacks motors of the frame.
ChosenTrack select_esc_power(const FlightSeries& series);

/// Returns the times, rising, at which the message of `source` ("ENERGY.current"; a user's CSV has no message) has a
/// power that is not its voltage times its current.
std::vector<double> contradicted_times(const FlightSeries& series, std::string_view source);

/// Returns the throttle for detecting dropouts of the candidate, a power or current; empty without one, and if the
/// candidate is never 0.
Track dropout_throttle(const FlightSeries& series, const Track& candidate);

}  // namespace flightwatt::flight
