#pragma once

#include "mission/sampling/flight_draws.h"

namespace flightwatt::mission {

/// One draw of a mission as a mission of its own.
inline MissionSetup apply_draw(const MissionSetup& mission, const FlightUncertainty& spreads,
                               std::span<const double> normals) {
    auto flight = mission;
    apply_draw(mission, spreads, normals, flight);
    return flight;
}

}  // namespace flightwatt::mission
