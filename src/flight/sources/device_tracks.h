#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <vector>

namespace flightwatt::flight {

/// The columns of a message that hold voltage [V] and current [A]; nullptr where it has none.
struct VoltageAndCurrent {
    const telemetry::Column* voltage = nullptr;
    const telemetry::Column* current = nullptr;
};
VoltageAndCurrent voltage_and_current(const telemetry::MessageTable& table);

/// Element by element; both are equally long.
std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b);

/// Adds power and current of every motor (ESC) and circuit (POWER_DEVICE), a track each: their sum over time
/// needs values between samples, so it is made when it is asked for.
void add_device_tracks(std::vector<Track>& tracks, const telemetry::SenderLog& sender);

}  // namespace flightwatt::flight
