#pragma once

#include "mission/mission.h"
#include "mission/mission_summary.h"
#include "mission/sampling/joint_spread.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// How the power of one component differs between flights.
struct ComponentSpread {
    double common_sd_percent = 0.0;  ///< of all its nodes together
    std::vector<double> node_sd_w;   ///< of each by itself; or empty
};

/// What differs between the flights of a mission: the one definition of it, for plans that keep a reserve with a
/// chance and for flights that are drawn. What is not in it is the same in every flight: initial charge, schedule,
/// cut-off voltage, and the course of the power within a flight beside its phases' levels.
struct FlightSpreads {
    PerPhase<double> level_sd_w;  ///< of a phase's mean mechanical power
    PerPhase<double> duration_sd_s;
    std::vector<JointSpread> of_flights;      ///< those of them that few flights show, and not the mission states
    std::vector<ComponentSpread> components;  ///< one a component of the mission
    battery::BatteryIntervals battery;        ///< 95 % intervals of what differs
    DrawnSources sources;
};

/// What the mission's [uncertainty] states, which is normal. Else: levels as level_deviation says; durations as the
/// model's flights show, in proportion, with the same factor for a flight to come, unless the mission states the
/// duration; both by Student's t, together as they were in the flights; computing by the standard errors of the
/// profile's nodes; the battery by the 95 % intervals of its file, but not a capacity that the mission states.
FlightSpreads find_spreads(const MissionSetup& mission);

/// How many standard normal numbers make a flight.
std::size_t count_normals(const MissionSetup& mission);

/// Flight number `index`'s, of `seed` and `index` alone.
std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index);

/// The mission as the flight of these numbers flies it, each of which moves one quantity by so many deviations: of each
/// phase level and duration, of the battery capacity, voltage, resistance, RC resistance and RC time constant, of each
/// component its power and that of each node, of a path the wind's speed and direction. Those that are estimated together move together (docs/methods.md, Eq.
/// 34); a level's deviation counts for the planned duration then, so that a phase's energy moves by the sum of what
/// level and duration do. Levels move a phase's whole curve; where that would take it further below 0 than it was, the
/// curve is scaled to the same mean, down to 0. The knots of an open-circuit voltage move together, each by its own
/// error. An interval has a deviation for each side; a time constant is normal in its logarithm. Durations stop at a
/// tenth of the planned and at ten times it, what cannot be negative at 0 (or a thousandth).
MissionSetup flight_of(const MissionSetup& mission, const FlightSpreads& spreads, std::span<const double> normals);

/// The flight that draw_normals makes.
MissionSetup draw_flight(const MissionSetup& mission, const FlightSpreads& spreads, std::uint64_t seed,
                         std::uint64_t index);

/// The mission without what only says where its models come from, which copies faster.
MissionSetup without_evidence(MissionSetup mission);

}  // namespace flightwatt::mission
