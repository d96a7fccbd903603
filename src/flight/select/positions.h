#pragma once

#include "flight/flight_data.h"

namespace flightwatt::flight {

/// Removes positions without a fix (latitude and longitude 0) and those that no aircraft reaches from the others in the
/// time between, with a note that counts them. Where these are more than half, they stay, and the note states so.
void remove_unreachable_positions(FlightData& data);

}  // namespace flightwatt::flight
