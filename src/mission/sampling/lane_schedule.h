#pragma once

#include "mission/mission.h"
#include "mission/sampling/flight_spreads.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// A part of a flight in which one configuration runs, wherever a flight's durations put it.
struct LaneSegment {
    Phase phase = Phase::takeoff;
    double from_part = 0.0;            ///< of its phase
    double to_part = 0.0;              ///< of it too
    std::size_t configuration = 0;     ///< of LaneSchedule::configurations
    std::size_t outputs_at_start = 0;  ///< how many of the times asked for are at its start
    std::size_t steps = 1;             ///< in which all flights fly it
    double max_s = 0.0;                ///< [s] longest duration of its phase for which these are fine enough
    std::vector<double> nodes;         ///< [parts of the stretch] where the power is looked at
    std::vector<double> weights;       ///< of the nodes, of a constant source: Gauss quadrature over the stretch
    /// Of stretched phases, at each node: cos and sin of the curve's angle, of twice it, ...; empty: they differ by
    /// flight.
    std::vector<std::vector<double>> harmonics;
};

/// What one node of a component's profile counts in the power of a configuration.
struct NodeWeight {
    std::size_t component = 0;
    std::size_t node = 0;
    double weight = 0.0;
};

/// A mission's schedule as far as it is the same in all of its flights.
struct LaneSchedule {
    std::vector<LaneSegment> stretches;
    std::vector<std::vector<NodeWeight>> configurations;
};

/// Of a mission without path and measured phases. `times_s` of the mission as planned, rising: stretches start there.
LaneSchedule lane_schedule(const MissionSetup& setup, const FlightUncertainty& spreads, const Schedule& schedule,
                           const std::vector<double>& times_s);

}  // namespace flightwatt::mission
