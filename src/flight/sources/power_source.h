#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// Measured electrical power over time, and where it came from.
struct MeasuredPower {
    Track power_w;
    std::string source;  ///< "ENERGY.power"
};

/// The power of one aircraft: ENERGY.power, else voltage times current (ENERGY, then BAT), else the ESCs' or
/// power devices' sum. A source that reads 0 throughout measures nothing and is passed over. Returns an empty
/// track if there is none; `passed_over` says what was looked at and why it was not taken.
MeasuredPower choose_power(const telemetry::SenderLog& sender, std::vector<std::string>& passed_over);

/// Measured current over time, and where it came from.
struct MeasuredCurrent {
    Track current_a;
    std::string source;
};

/// The current of an aircraft whose ESCs or else power devices report it one at a time: their sum. Empty if
/// neither does.
MeasuredCurrent summed_current(const telemetry::SenderLog& sender);

}  // namespace flightwatt::flight
