#pragma once

#include "flight/flight_series.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Which of the devices of `message` is not to be believed: one that stands still (30 reports alike, in current or in
/// power) while the others go on, and an ESC below 5 % of the others' median while these run. Told where more than
/// 4 % of the energy would be missing if it went with the others: an ESC draws their median, a circuit
/// (POWER_DEVICE) the part of their power that it drew otherwise. A circuit that draws the same small power
/// throughout is the electronics'; one that is 0 throughout is reported. So are devices of negative power, one that
/// reports the sum of two or more others, and ids that are missing between others.
std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message);

/// Why voltage and current of POWER_DEVICE are not the pack's: "its circuits have 5.0 to 12.3 V ...". Empty where their
/// voltages (energy over charge) lie within 10 %.
std::string differing_voltages_reason(const FlightSeries& series);

}  // namespace flightwatt::flight
