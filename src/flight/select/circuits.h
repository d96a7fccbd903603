#pragma once

#include "flight/flight_data.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// The electrical tracks of a log that numbers its battery monitors, not cleaned. A pack is what monitors that agree in
/// voltage and current see; a circuit is a set of packs at one voltage, whose currents add up; the power of circuits
/// adds up. A monitor that is the sum of others, and a spare input, are named and not counted.
struct BatteryTracks {
    std::vector<Circuit> circuits;  ///< the one with the most power first
    ChosenTrack power_w;            ///< of all circuits
    ChosenTrack energy_wh;          ///< counters of all circuits
    std::string note = {};          ///< of which batteries the power is the sum
};

/// std::nullopt without numbered monitors that measure a current.
std::optional<BatteryTracks> select_batteries(const FlightSeries& series);

}  // namespace flightwatt::flight
