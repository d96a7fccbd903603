#pragma once

#include "mission/mission.h"
#include "mission/sampling/flight_spreads.h"

#include <cstdint>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// Returns the number of standard normal numbers that a drawn flight needs.
std::size_t count_normals(const MissionSetup& mission);

/// Returns `count` standard normal numbers for flight number `index`, which depend on `seed` and `index` alone.
std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index);

/// Applies one draw of standard normal numbers to a mission (docs/methods.md, Drawn flights). `flight` is a copy of the
/// mission or an earlier drawn flight of it, which is overwritten, as copying less is faster. Order of the numbers:
/// mean power and duration of each phase; battery capacity, voltage, resistance, RC resistance and time constant; of
/// each component its power and that of each node; wind speed and direction; initial charge. Durations are limited to
/// 0.1 to 10 times the planned ones, mean powers by FlightUncertainty::max_rise_w.
void apply_draw(const MissionSetup& mission, const FlightUncertainty& spreads, std::span<const double> normals,
                MissionSetup& flight);

}  // namespace flightwatt::mission
