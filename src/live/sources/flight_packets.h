#pragma once

#include "flight/flight_data.h"
#include "live/sources.h"

#include <vector>

namespace flightwatt::live {

/// The highest current of a battery that a message states.
inline constexpr double max_mavlink_current_a = 327.67;

/// Returns the packets of MAVLink that an aircraft with these tracks would send, by rising time: a heartbeat, SYS_STATUS
/// and (landed or of a VTOL, if known) EXTENDED_SYS_STATE once a second, BATTERY_STATUS at each power,
/// GLOBAL_POSITION_INT and VFR_HUD at each altitude, with the values that are known then, and without a current that is
/// too high. Throws InputError without measured power and voltage.
std::vector<IncomingMessage> flight_packets(const flight::FlightData& data);

}  // namespace flightwatt::live
