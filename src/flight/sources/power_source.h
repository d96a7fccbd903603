#pragma once

#include "flight/flight_series.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Which of the series' power tracks is taken, and why not another.
struct PowerChoice {
    Track power_w;                         ///< empty if there is none
    std::vector<std::string> passed_over;  ///< "ENERGY.power is 0 throughout"
};

/// ENERGY.power, else voltage times current (ENERGY, then BAT), else the ESCs' or power devices' sum. A
/// source that reads 0 throughout measures nothing and is passed over, one that voltage times current
/// contradicts has another layout than was assumed.
PowerChoice choose_power(const FlightSeries& series);

/// Sum over the devices of `message` that report `name` one at a time, on the clock of the one that reports
/// most; empty if none does. `source` says of how many.
Track summed_over_devices(const FlightSeries& series, std::string_view name, std::string_view message);

/// The 4-field ENERGY without a .log, so that the order of its last two fields was assumed: whether they fit
/// the other way round (power is voltage times current). Its tracks are then those of source
/// power_read_as_energy and energy_read_as_power.
bool energy_and_power_are_exchanged(const FlightSeries& series);
inline constexpr auto energy_read_as_power = "ENERGY.energy read as power";
inline constexpr auto power_read_as_energy = "ENERGY.power read as energy";

}  // namespace flightwatt::flight
