#pragma once

#include "flight/flight_series.h"
#include "flight/select/device_sum.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Returns findings about the devices of `message` (docs/methods.md): a device that is stuck or reports almost nothing
/// while the others run, one that is negative or reports the sum of the others, and ids that are missing in the
/// sequence.
std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message);

/// Returns findings about packs of one circuit, by the tracks of their monitors: one that is stuck, or reports almost
/// nothing, while the others supply the motors.
std::vector<std::string> find_suspect_packs(std::vector<Device> powers, const std::vector<Device>& currents);

/// Returns the reason why voltage and current of POWER_DEVICE are not the pack's, "the circuits have 5.0 to 12.3 V
/// ..."; empty if the circuits' voltages (energy over charge) agree within 10 %.
std::string differing_voltages_reason(const FlightSeries& series);

}  // namespace flightwatt::flight
