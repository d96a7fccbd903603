#pragma once

#include "mission/mission.h"
#include "mission/sampling/flight_spreads.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// Number of standard normal numbers per flight.
std::size_t count_normals(const MissionSetup& mission);

/// Flight number `index`'s, of `seed` and `index` alone.
std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index);

/// Applies one draw of standard normal numbers to a mission (docs/methods.md, Drawn flights), onto `flight`: a copy of
/// it that may have been another flight before, as copying less is faster. Order of the numbers: mean power and duration
/// of each phase; battery capacity, voltage, resistance, RC resistance and time constant; of each component its power and
/// that of each node; wind speed and direction; initial charge. Durations are limited to 0.1 to 10 times the planned
/// ones, mean powers by FlightUncertainty::max_rise_w.
void apply_draw(const MissionSetup& mission, const FlightUncertainty& spreads, std::span<const double> normals,
                MissionSetup& flight);

}  // namespace flightwatt::mission
