#pragma once

#include "flight/flight_series.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A series without the samples at which the voltage of a battery is about 0 between others.
struct WithoutDropouts {
    std::optional<FlightSeries> series = {};  ///< absent if there are no such samples
    std::vector<std::string> warnings = {};   ///< one for each such voltage
};

/// Removes the samples at which the voltage of a battery is less than a tenth of its median between others, in runs of
/// any length, and with them the power that is their product, or 0, and a current of 0. An aircraft in use is not at
/// 0 V: the voltage is not measured there. A voltage that is 0 in more than half of its samples is kept as it is.
WithoutDropouts without_voltage_dropouts(const FlightSeries& series);

}  // namespace flightwatt::flight
