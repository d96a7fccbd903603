#pragma once

#include "flight/flight_data.h"

#include <optional>
#include <vector>

namespace flightwatt::flight {

/// The electrical tracks of a log that numbers its battery monitors, not cleaned. Monitors that agree in voltage and
/// current measure one pack; the packs at one voltage are a circuit, whose currents add up; the powers of circuits add
/// up. A monitor that measures the sum of others, and a spare input, are named but not added.
struct BatteryTracks {
    std::vector<Circuit> circuits;  ///< the one with the most power first
    ChosenTrack power_w;            ///< sum over all circuits
    ChosenTrack energy_wh;          ///< sum of the counters of all circuits
    std::string note = {};          ///< states of which batteries the power is the sum
};

/// Returns the cells in series of the monitor with that id, by the log; std::nullopt without, and beyond 1 to 100.
std::optional<int> stated_cells(const FlightSeries& series, const std::string& id);

/// Finds the packs and circuits of a series; std::nullopt without numbered monitors that measure a current.
std::optional<BatteryTracks> select_batteries(const FlightSeries& series);

}  // namespace flightwatt::flight
