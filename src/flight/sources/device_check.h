#pragma once

#include "flight/flight_series.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Which of the devices of `message` is not to be believed: one that stands still or reports next to nothing while the
/// others go on, that is negative, or reports what others do together; and which ids are missing between others. By the
/// rules of docs/methods.md.
std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message);

/// Why voltage and current of POWER_DEVICE are not the pack's: "its circuits have 5.0 to 12.3 V ...". Empty where their
/// voltages (energy over charge) lie within 10 %.
std::string differing_voltages_reason(const FlightSeries& series);

}  // namespace flightwatt::flight
